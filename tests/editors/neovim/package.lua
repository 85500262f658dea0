-- Tests the plugin as a package, with only options in init.lua: its commands, help and health, and its messages without
-- a server. run.sh starts it in an empty folder.

local harness = dofile(vim.env.TESTS .. '/harness.lua')
local wait, check, becomes = harness.wait, harness.check, harness.becomes
local open, text, go_to, notified = harness.open, harness.text, harness.go_to, harness.notified

local PLUGIN = vim.env.REPOSITORY .. '/editors/neovim'
local PROGRAM = harness.read(vim.env.PROGRAM)
local TWO = PROGRAM .. '\nenvironment area_2 has { robot_1 } robots with { mov_1 } moves\n'

--- Writes and opens a program.
local function open_program(name, program)
  vim.cmd('silent! only!')
  harness.write(name, program)
  open(name)
end

--- The text of the first buffer whose name has this ending.
local function shown(name)
  for _, buffer in ipairs(vim.api.nvim_list_bufs()) do
    if vim.endswith(vim.api.nvim_buf_get_name(buffer), name) then
      return text(buffer)
    end
  end
end

local function before_the_server()
  local path = vim.env.PATH
  vim.env.PATH = '/nowhere'
  harness.write('early.pyr', PROGRAM)
  local function edit() vim.cmd.edit('early.pyr') end
  local missing = notified('`pydslrep-lsp` was not found', edit)
  check('the message says how to install it', missing and missing:find('cargo install', 1, true), missing)
  local _, again = notified('all is said', function()
    vim.cmd.edit()
    vim.cmd.checkhealth('pydslrep')
    vim.schedule(function() vim.notify('all is said') end)
  end)
  check('only once', #again == 1, again)
  local health = text()
  check('health reports it', health:find('ERROR `pydslrep-lsp` was not found', 1, true), health)
  check('and how to install it', health:find('cargo install --locked --path crates/server', 1, true), health)
  vim.cmd.bwipeout()
  check('programs are highlighted without it', vim.bo.syntax == 'pydslrep')
  go_to('robot_1')
  local colours = vim.inspect_pos().syntax
  check('by the syntax file', colours[1] and colours[1].hl_group == 'pydslrepRobot', colours)
  check('which folds', vim.wo.foldmethod == 'syntax' and vim.fn.foldlevel(8) == 1, vim.fn.foldlevel(8))
  check('with open folds', vim.fn.foldclosed(8) == -1)
  vim.env.PATH = path
end

local function file_type()
  vim.cmd.edit('early.pyr')
  wait(function() return harness.client() and harness.client().initialized end)
  check('a package needs no configuration', harness.client() ~= nil)
  assert(harness.client(), 'without a server, there is nothing to see')
  becomes('the server folds once it is attached', 'v:lua.vim.lsp.foldexpr()', function() return vim.wo.foldexpr end)
  becomes('a movement', 1, function() return vim.fn.foldlevel(8) end)
  check('which is open', vim.fn.foldclosed(8) == -1)
  go_to('move 4')
  vim.api.nvim_input('gcc')
  becomes('a line is commented out', '  // move 4.0 meters', vim.api.nvim_get_current_line)
  vim.api.nvim_input('gcc')
  becomes('and back in', '  move 4.0 meters', vim.api.nvim_get_current_line)
  vim.api.nvim_input('O/* a<CR>b')
  becomes('comments continue on the next line', { '  /* a', '   * b' }, function()
    local line = vim.fn.line('.')
    return vim.api.nvim_buf_get_lines(0, line - 2, line, false)
  end)
  vim.api.nvim_input('<Esc>')
  harness.write('part.pyr', '')
  vim.api.nvim_buf_set_lines(0, 0, 0, false, { 'import "part.pyr"' })
  go_to('part')
  vim.cmd('silent write')
  vim.api.nvim_input('gf')
  becomes('gf opens an imported file', 'part.pyr', function() return vim.fn.expand('%:t') end)
  vim.cmd('bwipeout!')
  vim.cmd.edit('early.pyr')
  vim.bo.filetype = 'text'
  check('another file type has its own options', vim.bo.commentstring ~= '// %s' and vim.bo.indentexpr == '',
    { vim.bo.commentstring, vim.bo.indentexpr })
  vim.cmd('bwipeout!')
end

local NESTED = [[
robot r with port 1 has {
  left right
} wheels with sensors {
  front } // and no more: {

/* In front of it:
 * { nothing }
 */
movement m of r {
  turn left until {
    front
    back
  }
  /*
   * Then on.
   */
  slam
  repeat until { front } detect {
    if { front back } clear { // {
      do side
    } else if { back } detect {
      repeat 4 times { turn left until { front } }
    } else {
      /* } */
      slam
    }
    turn left
  }
}
]]

local function indentation()
  local folder = vim.env.REPOSITORY
  local programs = vim.fn.glob(folder .. '/tests/paper/*.pyr', true, true)
  vim.list_extend(programs, vim.fn.glob(folder .. '/examples/*.pyr', true, true))
  check('there are programs', #programs > 8, programs)
  local layouts = { nested = NESTED }
  for _, program in ipairs(programs) do
    layouts[program] = vim.system({ 'pydslrep', 'fmt', '-' }, { stdin = harness.read(program) }):wait().stdout
  end
  local wrong = {}
  for program, layout in pairs(layouts) do
    harness.write('indented.pyr', (layout:gsub('\n[ \t]+', '\n')))
    vim.cmd.edit({ args = { 'indented.pyr' }, bang = true })
    vim.cmd('silent normal! gg=G')
    if text() ~= layout then
      table.insert(wrong, { program, text() })
    end
  end
  check('lines are indented like formatted programs', #wrong == 0, wrong)
  vim.cmd('bwipeout!')
end

local function command()
  local function offered(line) return vim.fn.getcompletion(line, 'cmdline') end
  local words = {
    'check', 'generate', 'health', 'log', 'parser', 'preview', 'push', 'remove', 'restart', 'run', 'stop',
  }
  check('the command completes subcommands', vim.deep_equal(offered('Pydslrep '), words), offered('Pydslrep '))
  open_program('two.pyr', TWO)
  check('and environments', vim.deep_equal(offered('Pydslrep run '), { 'area_1', 'area_2' }), offered('Pydslrep run '))
  check('and nothing for subcommands without an argument', vim.deep_equal(offered('Pydslrep stop '), {}))
  local unknown = notified('unknown subcommand `rnu`', function() vim.cmd('Pydslrep rnu') end)
  check('unknown subcommands are reported', unknown and unknown:find('generate, health', 1, true), unknown)
  local more = notified('takes no argument', function() vim.cmd('Pydslrep stop it') end)
  check('and surplus arguments', more)
end

local function while_typing()
  open_program('typed.pyr', PROGRAM)
  local function codes()
    return vim.tbl_map(function(found) return found.code end, vim.diagnostic.get(0, { severity = 1 }))
  end
  local function type_into(keys, expected)
    vim.api.nvim_input(keys)
    wait(function() return text():find(expected, 1, true) end)
    -- Neovim sends what was typed before it sends a request.
    local params = { textDocument = { uri = vim.uri_from_bufnr(0) } }
    harness.client():request_sync('textDocument/foldingRange', params, 60000, 0)
  end
  go_to('wheelR }')
  type_into('ciw', '{ wheelL  }')
  type_into('w', '{ wheelL w }')
  check('the problem of a name that is being typed is not shown', #codes() == 0, codes())
  vim.api.nvim_input('<Esc>j')
  becomes('it is shown when the line is left', { 'unresolved-reference' }, codes)
end

local function options()
  local function notes()
    local codes = vim.tbl_map(function(found) return found.code end, vim.diagnostic.get(0))
    table.sort(codes)
    return codes
  end
  open_program('unused.pyr', 'wheel spare with radius 4.5\nsensor 1\n' .. PROGRAM)
  -- One of three problems is switched off.
  becomes('settings reach the server', { 'port-of-other-target', 'syntax-error' }, notes)
  local chosen = vim.g.pydslrep
  local wrong = notified('unknown option `setings`', function()
    require('pydslrep').setup({ setings = {}, highlight = 1 })
  end)
  check('problems in the options are reported', wrong and wrong:find('`highlight` must be a boolean', 1, true), wrong)
  vim.cmd.checkhealth('pydslrep')
  check('also by :checkhealth', text():find('unknown option `setings`', 1, true), text())
  vim.cmd.bwipeout()
  vim.g.pydslrep = chosen
end

local function generate()
  open_program('two.pyr', TWO)
  local wanted = vim.system({ 'pydslrep', 'build', '--stdout', '--environment', 'area_2', 'two.pyr' }):wait().stdout
  vim.cmd('Pydslrep generate area_2')
  becomes('the script of an environment is written', wanted, function() return harness.read('area_2.py') end)
  becomes('and shown next to the program', true, function() return vim.fn.bufwinid('area_2.py') > 0 end)
  check('the cursor stays in the program', vim.fn.expand('%:t') == 'two.pyr')
  local select, asked = vim.ui.select, nil
  vim.ui.select = function(items, how, choose)
    asked = vim.tbl_map(how.format_item, items)
    choose(items[1], 1)
  end
  go_to('wheel')
  vim.cmd('Pydslrep generate')
  becomes('with several environments, a list asks which', { 'area_1', 'area_2' }, function() return asked end)
  becomes('and the chosen script is written', true, function() return harness.read('area_1.py') ~= nil end)
  vim.ui.select = select
  open_program('none.pyr', 'wheel w with radius 4.5\n')
  check('a missing environment is reported', notified('has no environment', function() vim.cmd('Pydslrep run') end))
  open_program('broken.pyr', (PROGRAM:gsub('{ wheelL wheelR }', '{ wheelL whelR }')))
  local why = notified('no wheel called `whelR`', function() vim.cmd('Pydslrep run') end)
  check('a broken program does not run; a message says why', why, why)
  vim.cmd.enew()
  check('without a server, a message says so', notified('not attached', function() vim.cmd('Pydslrep run') end))
end

local function preview()
  open_program('square.pyr', PROGRAM)
  go_to('environment')
  _G.opened = nil
  vim.cmd('Pydslrep preview')
  local picture = wait(function() return _G.opened end)
  check('the planned path is drawn and opened', picture and vim.endswith(picture, '.svg'), picture)
  check('as a picture', picture and harness.read(picture):find('<svg', 1, true))
  local table_of_poses = wait(function() return shown('pydslrep://area_1/preview') end) or ''
  check('its poses are listed', table_of_poses:find('robot_1', 1, true), table_of_poses)
  check('and the file of the picture', picture and table_of_poses:find(picture, 1, true), table_of_poses)
  check('the cursor stays in the program', vim.fn.expand('%:t') == 'square.pyr')
end

local function live_preview()
  open_program('square.pyr', PROGRAM)
  go_to('robot_1')
  local open_outside, address = vim.ui.open, nil
  vim.ui.open = function(path)
    address = path
    return nil, 'there is no browser'
  end
  vim.cmd('messages clear')
  vim.cmd('PydslrepPreview area_1')
  wait(function() return address end)
  becomes('and without a browser, its address is printed', true, function()
    return vim.fn.execute('messages'):find('path preview: ' .. address, 1, true) ~= nil
  end)
  vim.ui.open = open_outside
  check('the live preview is opened', address and address:find('^http://127%.0%.0%.1:%d+/%x+/$'), address)
  local received = ''
  local listening = vim.system({ 'curl', '-sN', address .. 'events' }, {
    stdout = function(_, data) received = received .. (data or '') end,
  })
  local function cursor()
    local _, _, line = received:find('.*"line":(%d+)')
    return tonumber(line)
  end
  becomes('its page has the cursor', vim.fn.line('.') - 1, cursor)
  check('and the chosen environment', received:find('"environment":"area_1"', 1, true), received)
  vim.api.nvim_input('gg3j')
  becomes('and follows it', 3, cursor)
  vim.api.nvim_input('ox<Esc>')
  becomes('also while typing', true, function() return received:find('"isEdit":true', 1, true) ~= nil end)
  vim.cmd('silent undo')
  local location = { uri = vim.uri_from_bufnr(0), range = { start = { line = 6, character = 2 } } }
  location.range['end'] = { line = 6, character = 17 }
  local reveal = { jsonrpc = '2.0', id = 1, method = 'pydslrep/reveal', params = location }
  local origin = address:match('^http://[^/]+')
  vim.system({ 'curl', '-s', '-H', 'Origin: ' .. origin, '-H', 'Content-Type: application/json',
    '-d', vim.json.encode(reveal), address .. 'messages' })
  becomes('a click in it moves the cursor', 7, function() return vim.fn.line('.') end)
  listening:kill('sigterm')
end

--- The messages so far.
local function messages()
  return vim.fn.execute('messages')
end

local function run()
  _G.opened = nil
  vim.cmd('silent! only!')
  go_to('environment')
  vim.cmd('messages clear')
  vim.cmd('Pydslrep run')
  local seen = {}
  local driven
  -- The first run on a machine installs Python packages.
  for _ = 1, 12 do
    driven = wait(function()
      for name in pairs((harness.client() or { progress = {} }).progress.pending or {}) do seen[name] = true end
      return shown('pydslrep://area_1/run')
    end)
    if driven then break end
  end
  check('an environment runs', driven and driven:find('robot_1', 1, true), driven or messages())
  check('its progress is shown', vim.iter(pairs(seen)):any(function(token) return token:find('^pydslrep%-') end), seen)
  check('its picture is opened', _G.opened and _G.opened:find('driven', 1, true), _G.opened)
  becomes('its end is reported', true, function() return messages():find('done', 1, true) ~= nil end)
end

local function failed_run()
  harness.write('blocked.scene.toml', '[[box]]\nname = "crate"\nat = [0.6, 0]\nsize = [0.2, 2]\n')
  open_program('blocked.pyr', (PROGRAM:gsub('area_1', 'blocked')))
  local function marks()
    return vim.iter(vim.diagnostic.get(0)):filter(function(one) return one.source == 'pydslrep run' end):totable()
  end
  vim.cmd('Pydslrep run')
  local place = wait(function() return marks()[1] end)
  local marked = place and vim.fn.getline(place.lnum + 1)
  check('the action that failed is marked', marked and marked:find('move', 1, true), marked or messages())
  vim.cmd('Pydslrep run')
  becomes('until the next run', 0, function() return #marks() end)
  vim.cmd('Pydslrep stop')
  becomes('and that run is stopped', true, function() return messages():find('stopped', 1, true) ~= nil end)
end

local function stop()
  vim.cmd('silent! only!')
  local slow = PROGRAM:gsub('move 4.0 meters', 'move 900.0 meters')
  open_program('slow.pyr', slow)
  vim.cmd('messages clear')
  vim.cmd('Pydslrep run')
  local function runs()
    local server = harness.process()
    return #vim.api.nvim_get_proc_children(server) > 0
  end
  check('a run is a process of the server', wait(runs))
  check('a second run does not start', notified('is still running', function() vim.cmd('Pydslrep run') end))
  vim.cmd('Pydslrep stop')
  becomes('a stopped run is reported', true, function() return messages():find('stopped', 1, true) ~= nil end)
  becomes('and its process has exited', false, runs)
  check('then nothing runs', notified('nothing is running', function() vim.cmd('Pydslrep stop') end))
  vim.cmd('Pydslrep run')
  check('and another can be started', wait(runs))
  local server = harness.process()
  local child = vim.api.nvim_get_proc_children(server)[1]
  vim.uv.kill(server, 'sigkill')
  becomes('the exit of the server is reported', true, function()
    return messages():find('the server exited', 1, true) ~= nil
  end)
  -- A killed server cannot stop its child processes.
  vim.uv.kill(child, 'sigint')
end

local function lenses()
  open_program('square.pyr', PROGRAM)
  if not vim.lsp.codelens.enable then return end
  -- Neovim 0.12 asks for the lenses of a file that it has just opened once more. If it draws the first answer while the
  -- second arrives, it leaves those unresolved. So this waits until the server has opened the file.
  wait(function() return #vim.diagnostic.get(0) > 0 end)
  vim.lsp.codelens.enable(true, { bufnr = 0 })
  go_to('mov_1 of')
  local function count()
    -- What is drawn is resolved.
    vim.cmd('redraw!')
    return vim.iter(vim.lsp.codelens.get({ bufnr = 0 })):any(function(item)
      return item.lens.command and item.lens.command.title == '1 reference'
    end)
  end
  check('the lens of a movement counts its references', wait(count))
  vim.api.nvim_input('grx')
  becomes('the lens of a movement lists its references', { 14 }, function()
    return vim.tbl_map(function(item) return item.lnum end, vim.fn.getqflist())
  end)
  vim.cmd.cclose()
  vim.lsp.codelens.enable(false, { bufnr = 0 })
end

local function life()
  open_program('square.pyr', PROGRAM)
  local first = harness.client().id
  vim.cmd('Pydslrep restart')
  local function restarted()
    return harness.client() and harness.client().initialized and harness.client().id ~= first
  end
  check('the server can be restarted', wait(restarted))
  vim.api.nvim_buf_set_lines(0, 0, 1, false, {})
  becomes('and responds', 'unresolved-reference', function() return (harness.errors()[1] or {})[5] end)
  vim.cmd('Pydslrep health')
  local health = text()
  check('health reports the server\'s version', health:match('OK [^\n]*pydslrep%-lsp: pydslrep%-lsp %d+%.%d+'), health)
  check('that it runs', health:find('running for %d+ buffer'), health)
  check('the command\'s version', health:match('for runs and previews: pydslrep %d+%.%d+'), health)
  check('and Python\'s version', health:match('Python 3%.%d+'), health)
  vim.cmd.bwipeout()
  vim.cmd('Pydslrep log')
  check('the log can be opened', vim.fn.expand('%:t') == 'lsp.log', vim.fn.expand('%'))
  vim.cmd.tabclose()
  harness.write('../server.pid', tostring(harness.process()))
end

local function help()
  vim.cmd.help('pydslrep')
  check('help is available', vim.fn.expand('%:t') == 'pydslrep.txt' and vim.bo.filetype == 'help', vim.fn.expand('%'))
  local broken = {}
  for tag in text():gmatch('|([^|%s]+)|') do
    if not pcall(vim.cmd.help, { args = { vim.fn.escape(tag, '*') } }) then
      table.insert(broken, tag)
    end
  end
  check('without broken links', #broken == 0, broken)
  vim.cmd('silent! helpclose')
  local long = {}
  for line in io.lines(PLUGIN .. '/doc/pydslrep.txt') do
    if vim.fn.strdisplaywidth(line) > 79 then table.insert(long, line) end
  end
  check('and with short lines', #long == 0, long)
  -- The tags are in the repository, because nothing generates them for a folder appended to 'runtimepath'.
  vim.fn.mkdir('doc')
  vim.uv.fs_copyfile(PLUGIN .. '/doc/pydslrep.txt', 'doc/pydslrep.txt')
  vim.cmd.helptags('doc')
  check('its tags are up to date', harness.read('doc/tags') == harness.read(PLUGIN .. '/doc/tags'))
end

harness.run({
  before_the_server, file_type, indentation, command, while_typing, options, generate, preview, live_preview, run,
  failed_run, stop, lenses, help, life,
})
