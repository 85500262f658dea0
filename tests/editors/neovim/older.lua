-- Tests the oldest supported Neovim, whose missing LSP features the plugin replaces.

local harness = dofile(vim.env.TESTS .. '/harness.lua')
local wait, check, becomes = harness.wait, harness.check, harness.becomes
local open, text, go_to, notified = harness.open, harness.text, harness.go_to, harness.notified

local PROGRAM = harness.read(vim.env.PROGRAM)
local TYPO = PROGRAM:gsub('{ wheelL wheelR }', '{ wheelL whelR }')

local function codes()
  return vim.tbl_map(function(found) return found.code end, vim.diagnostic.get(0, { severity = 1 }))
end

local function server()
  check('Neovim cannot start servers by itself', vim.lsp.enable == nil)
  harness.write('typo.pyr', TYPO)
  open('typo.pyr')
  check('the server is attached', harness.client() ~= nil)
  assert(harness.client(), 'without a server, there is nothing to see')
  becomes('the typo is underlined', { 'unresolved-reference' }, codes)
  go_to('whelR')
  vim.api.nvim_input('ciwwh<C-x><C-o>')
  becomes('completion offers the wheel not listed yet', { 'wheelR' }, function()
    return vim.tbl_map(function(item) return item.abbr end, vim.fn.complete_info({ 'items' }).items)
  end)
  vim.api.nvim_input('<Esc>')
  becomes('which fixes the program', {}, codes)
  go_to('robot_1')
  becomes('names have the server\'s colours', true, function()
    local tokens = vim.inspect_pos().semantic_tokens
    return tokens[1] ~= nil and tokens[1].opts.hl_group:find('class') ~= nil
  end)
  harness.write('pydslrep.toml', '[sevrity]\n')
  open('pydslrep.toml')
  becomes('settings files are checked', { 'unknown-key' }, codes)
  harness.write('other.toml', 'x = 1\n')
  vim.cmd('edit! other.toml')
  check('other TOML is not', not harness.client())
  vim.uv.fs_unlink('pydslrep.toml')
end

local function commands()
  harness.write('square.pyr', PROGRAM)
  open('square.pyr')
  local picture
  vim.g.pydslrep = { open = function(path) picture = path end }
  vim.cmd('Pydslrep preview')
  check('the planned path is drawn and opened', wait(function() return picture end))
  local name = 'pydslrep://area_1/preview'
  check('its poses are listed', wait(function() return vim.fn.bufnr(name) > 0 and text(vim.fn.bufnr(name)) end))
  vim.cmd('messages clear')
  local first = harness.client().id
  vim.cmd('Pydslrep restart')
  local function restarted()
    return harness.client() and harness.client().initialized and harness.client().id ~= first
  end
  check('the server can be restarted', wait(restarted))
  check('the parser is built', notified('built ', function() vim.cmd('Pydslrep parser') end))
  check('and highlights', vim.treesitter.highlighter.active[vim.api.nvim_get_current_buf()])
  vim.cmd('edit')
  local method = vim.wo.foldmethod .. ' ' .. vim.wo.foldexpr
  check('and folds', method == 'expr v:lua.vim.treesitter.foldexpr()', method)
  becomes('and the server responds', {}, codes)
  vim.cmd('Pydslrep health')
  local health = text()
  check('health reports what this Neovim lacks', health:find('lacks some LSP features', 1, true), health)
  check('and that the server runs', health:find('running for %d+ buffer'), health)
  vim.cmd.bwipeout()
  harness.write('../server.pid', tostring(harness.process()))
end

harness.run({ server, commands })
