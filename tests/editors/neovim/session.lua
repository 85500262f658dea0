-- Edits programs in Neovim, key by key. run.sh starts it in an empty folder. Prints one line per check; the exit code
-- says whether all passed.

local harness = dofile(vim.env.TESTS .. '/harness.lua')
local wait = harness.wait
local check = harness.check
local becomes = harness.becomes
local read = harness.read
local write = harness.write
local client = harness.client
local process = harness.process
local open = harness.open
local text = harness.text
local go_to = harness.go_to
local errors = harness.errors
local act = harness.act

local FIXED = read(vim.env.PROGRAM)
local TYPO = FIXED:gsub('{ wheelL wheelR }', '{ wheelL whelR }')

--- The error in `TYPO`, shifted right by `shift` bytes.
local function unknown(shift)
  return { { 3, 51 + (shift or 0), 3, 56 + (shift or 0), 'unresolved-reference' } }
end

local function diagnostics()
  write('typo.pyr', TYPO)
  open('typo.pyr')
  check('the file type is pydslrep', vim.bo.filetype == 'pydslrep', vim.bo.filetype)
  check('the server is attached', client() ~= nil)
  assert(client(), 'without a server, there is nothing to see')
  check('columns are counted in UTF-8', client().offset_encoding == 'utf-8', client().offset_encoding)
  becomes('the typo is underlined, with its code', unknown(), errors)
end

local function no_script_of_a_broken_program()
  local message
  local notify = vim.notify
  vim.notify = function(shown) message = shown end
  act('Generate script')
  wait(function() return message end)
  vim.notify = notify
  check('a broken program has no script', message and message:find('no wheel called `whelR`'), message)
end

local function completion()
  vim.o.completeopt = 'menuone,noselect'
  local function offered(keys)
    vim.api.nvim_input(keys .. '<C-x><C-o>')
    wait(function() return vim.fn.pumvisible() == 1 end)
    return vim.tbl_map(function(item) return item.abbr end, vim.fn.complete_info({ 'items' }).items)
  end
  go_to('whelR')
  local wheels = offered('ciwwh')
  check('completion offers the wheel not listed yet', vim.deep_equal(wheels, { 'wheelR' }), wheels)
  vim.api.nvim_input('<C-n><C-y><Esc>')
  becomes('and inserts it', FIXED, text)
  becomes('which fixes the program', {}, errors)
  go_to('turn right')
  local actions = offered('Omo')
  check('completion offers actions', vim.tbl_contains(actions, 'move … meters'), actions)
  local place = 0
  for index, label in ipairs(actions) do if label == 'move … meters' then place = index end end
  vim.api.nvim_input(('<C-n>'):rep(place) .. '<C-y>')
  becomes('an action is expanded', '  move 4.0 meters', vim.api.nvim_get_current_line)
  becomes('with its first placeholder selected', 's', function() return vim.api.nvim_get_mode().mode end)
  vim.api.nvim_input('2.5<Esc>')
  becomes('and overtyped', '  move 2.5 meters', vim.api.nvim_get_current_line)
  vim.snippet.stop()
  open('typo.pyr')
  becomes('reloaded, the typo is back', unknown(), errors)
end

local function reading()
  go_to('wheelR with')
  vim.api.nvim_input('K')
  local function float()
    for _, window in ipairs(vim.api.nvim_list_wins()) do
      if vim.api.nvim_win_get_config(window).relative ~= '' then
        local lines = text(vim.api.nvim_win_get_buf(window))
        return lines:find('28.3 cm per revolution', 1, true) and window
      end
    end
  end
  local window = wait(float)
  check('hovering over a wheel shows its circumference', window)
  if window then vim.api.nvim_win_close(window, true) end

  go_to('robot_1 {')
  vim.api.nvim_input('<C-]>')
  becomes('a reference leads to its definition', { 4, 6 }, function() return vim.api.nvim_win_get_cursor(0) end)

  vim.api.nvim_input('gO')
  local function outline()
    return vim.tbl_map(function(item) return item.text:gsub(' %(.*', '') end, vim.fn.getloclist(0))
  end
  local names = wait(function() return #outline() > 0 and outline() end)
  local all = names and table.concat(names, ' ') or ''
  check('the outline names every entity', all:find('wheelR.*wheelL.*robot_1.*mov_1.*area_1'), names)
  vim.cmd('lclose')

  local function colour(pattern)
    go_to(pattern)
    local place = vim.api.nvim_win_get_cursor(0)
    local groups = vim.tbl_map(function(token) return token.opts.hl_group end,
      vim.inspect_pos(0, place[1] - 1, place[2]).semantic_tokens)
    table.sort(groups)
    return groups
  end
  becomes('a keyword has its colour', { '@lsp.type.keyword.pydslrep' }, function() return colour('robot') end)
  becomes('a name has its colour', {
    '@lsp.mod.declaration.pydslrep', '@lsp.type.class.pydslrep', '@lsp.typemod.class.declaration.pydslrep',
  }, function() return colour('robot_1') end)
end

local function beside_the_program()
  write('square.pyr', FIXED)
  open('square.pyr')
  vim.lsp.inlay_hint.enable(true, { bufnr = 0 })
  local function hints()
    local found = {}
    for _, hint in ipairs(vim.lsp.inlay_hint.get({ bufnr = 0 })) do
      found[hint.inlay_hint.position.line + 1] = hint.inlay_hint.label
    end
    return found
  end
  go_to('move 4')
  local line = vim.api.nvim_win_get_cursor(0)[1]
  local function ends() return (hints()[line] or ''):match('→ 4%.00, 0%.00, 0°$') end
  check('a hint after an action shows the pose where it ends', wait(ends), hints())
  vim.lsp.inlay_hint.enable(false, { bufnr = 0 })

  if vim.lsp.codelens.enable then
    vim.lsp.codelens.enable(true, { bufnr = 0 })
    local function titles()
      local found = {}
      for _, item in ipairs(vim.lsp.codelens.get({ bufnr = 0 })) do
        local lens = item.lens
        table.insert(found, lens.command and lens.command.title or '?')
      end
      return table.concat(found, ', ')
    end
    local wanted = 'Run, Preview, Generate script'
    check('lenses above an environment', wait(function() return titles():find(wanted) end), titles())
    check('a lens above a robot', wait(function() return titles():find('2 references') end), titles())
    vim.lsp.codelens.enable(false, { bufnr = 0 })
  end

  vim.wo.foldmethod, vim.wo.foldexpr, vim.wo.foldlevel = 'expr', 'v:lua.vim.lsp.foldexpr()', 0
  go_to('movement')
  local first = vim.api.nvim_win_get_cursor(0)[1]
  wait(function() return vim.fn.foldlevel(first + 2) > 0 end)
  local function folded() vim.cmd('normal! zM') return vim.fn.foldclosed(first + 2) end
  becomes('a movement can be folded', first, folded)
  vim.wo.foldmethod, vim.wo.foldlevel = 'manual', 99
  vim.cmd('normal! zE')
end

local function while_typing()
  write('typed.pyr', FIXED)
  open('typed.pyr')
  go_to('turn right')
  vim.api.nvim_input('Omove <C-s>')
  local function signature()
    for _, window in ipairs(vim.api.nvim_list_wins()) do
      if vim.api.nvim_win_get_config(window).relative ~= '' then
        local lines = text(vim.api.nvim_win_get_buf(window))
        return lines:find('move DISTANCE meters | centimeters [at SPEED]', 1, true) and window
      end
    end
  end
  check('the syntax of a statement is shown while it is typed', wait(signature))
  vim.api.nvim_input('<Esc>')
  open('typed.pyr')
  if not vim.lsp.on_type_formatting then return end
  vim.lsp.on_type_formatting.enable()
  go_to('environment')
  vim.api.nvim_input('Omovement   m_2 of    robot_1 { turn   left }')
  becomes('a closing brace formats a movement', true, function()
    return text():find('movement m_2 of robot_1 {\n  turn left\n}', 1, true) ~= nil
  end)
  vim.api.nvim_input('<Esc>')
  vim.lsp.on_type_formatting.enable(false)
end

local function rewriting()
  write('rewritten.pyr', FIXED)
  open('rewritten.pyr')
  go_to('move 4')
  local titles = act('Convert to centimeters')
  check('refactorings are offered', titles and vim.tbl_contains(titles, 'Convert to centimeters'), titles)
  becomes('and applied', true, function() return text():find('move 400', 1, true) ~= nil end)
end

local function renaming()
  write('renamed.pyr', FIXED)
  open('renamed.pyr')
  go_to('wheelL with')
  local input = vim.ui.input
  vim.ui.input = function(options, answer) answer(options.default .. '2') end
  vim.api.nvim_input('grn')
  becomes('a rename changes a declaration and its uses', (FIXED:gsub('wheelL', 'wheelL2')), text)
  vim.ui.input = input
end

local function formatting()
  write('formatted.pyr', (FIXED:gsub('\n  ', '\n'):gsub('with radius', 'with   radius')))
  open('formatted.pyr')
  vim.lsp.buf.format({ async = true })
  becomes('a program can be formatted', FIXED, text)
end

local function files_that_move()
  write('parts.pyr', 'wheel a with radius 4.5\nwheel b with radius 4.5\n')
  write('main.pyr', 'import "parts.pyr"\nrobot r type tw with port 1 has { a b } wheels\n')
  open('main.pyr')
  becomes('an import is resolved', {}, errors)
  local old = vim.uri_from_fname(vim.fn.fnamemodify('parts.pyr', ':p'))
  local new = old:gsub('parts%.pyr$', 'lib/parts.pyr')
  local moved = { files = { { oldUri = old, newUri = new } } }
  -- As file managers in Neovim do; it has no command for this.
  local answer = client():request_sync('workspace/willRenameFiles', moved, 10000, 0)
  vim.lsp.util.apply_workspace_edit(answer.result, client().offset_encoding)
  becomes('an import follows its file', 'import "lib/parts.pyr"', function() return vim.fn.getline(1) end)
  vim.fn.mkdir('lib')
  vim.uv.fs_rename('parts.pyr', 'lib/parts.pyr')
  client():notify('workspace/didRenameFiles', moved)
  vim.cmd.write()
end

local function two_windows()
  local program = vim.api.nvim_get_current_buf()
  local function problem() return (errors(program)[1] or {})[5] end
  vim.cmd.split('lib/parts.pyr')
  go_to('a with')
  vim.api.nvim_input('rc')
  becomes('an edit breaks the program that imports the file that has moved', 'unresolved-reference', problem)
  vim.api.nvim_input('u')
  becomes('until it is undone', nil, problem)
  vim.cmd.close()
end

local function settings_file()
  write('pydslrep.toml', '[sevrity]\nwheel-count = "off"\n')
  open('pydslrep.toml')
  check('the server of the programs checks their settings', #vim.lsp.get_clients() == 1, #vim.lsp.get_clients())
  local function codes()
    return vim.tbl_map(function(found) return found.code end, vim.diagnostic.get(0))
  end
  becomes('a misspelt key in a settings file is underlined', { 'unknown-key' }, codes)
  go_to('sevrity')
  act('severity')
  becomes('and fixed', '[severity]', function() return vim.fn.getline(1) end)
  becomes('and no longer underlined', {}, codes)
  vim.cmd('bwipeout!')
  vim.uv.fs_unlink('pydslrep.toml')
  write('yard.scene.toml', '[wrold]\nseed = 2\n')
  open('yard.scene.toml')
  becomes('a misspelt key in a scene is underlined', { 'unknown-key' }, codes)
  go_to('wrold')
  act('world')
  becomes('and fixed', '[world]', function() return vim.fn.getline(1) end)
  vim.cmd('bwipeout!')
  vim.uv.fs_unlink('yard.scene.toml')
  write('other.toml', 'x = 1\n')
  vim.cmd.edit('other.toml')
  local other = vim.api.nvim_get_current_buf()
  -- What is opened after it has its client first.
  write('pydslrep.toml', '')
  open('pydslrep.toml')
  becomes('a file that is opened later has the client', true, function() return client() ~= nil end)
  check('other TOML is ignored', #vim.lsp.get_clients({ bufnr = other }) == 0)
  vim.cmd('bwipeout!')
  vim.cmd.bwipeout({ args = { tostring(other) }, bang = true })
  vim.uv.fs_unlink('pydslrep.toml')
end

local function quick_fix()
  open('typo.pyr')
  becomes('reloaded as it was, the typo is still underlined', unknown(), errors)
  go_to('whelR')
  local titles = act('wheelR')
  check('a quick fix is offered first', titles and titles[1]:find('wheelR'), titles)
  becomes('and fixes the text', FIXED, text)
  becomes('and removes the underline', {}, errors)
  vim.cmd.write()
end

local function script()
  local built = vim.system({ 'pydslrep', 'build', '--stdout', 'typo.pyr' }):wait().stdout
  local function shown()
    local buffer = vim.fn.bufnr('area_1.py')
    return buffer > 0 and text(buffer) or nil
  end
  local titles = act('Generate script')
  local offered = { 'Generate script area_1.py', 'Create scene area_1.scene.toml' }
  check('Generate script is offered', vim.deep_equal(titles, offered), titles)
  becomes('the script is generated', built, shown)
  vim.cmd.wall()
  check('it is identical to what the command builds', read('area_1.py') == built)

  vim.cmd.bwipeout('area_1.py')
  write('older.txt', (FIXED:gsub('4%.0', '3.0')))
  local older = vim.system({ 'sh', '-c', 'pydslrep build --stdout - < older.txt' }):wait().stdout
  check('an older script is another one', older:find('move%(3.0%)') and older ~= built, older)
  write('area_1.py', older)
  act('Generate script')
  becomes('a script on the disk is replaced', built, shown)
  check('only in its buffer until it is saved', read('area_1.py') == older)
  vim.cmd.sbuffer('area_1.py')
  vim.api.nvim_input('u')
  becomes('undo restores it', older, shown)

  vim.api.nvim_input('ggdGiunsaved<Esc>')
  becomes('it can be edited', 'unsaved\n', shown)
  vim.cmd.wincmd('p')
  act('Generate script')
  becomes('a script open with unsaved text is replaced', built, shown)
  vim.cmd.wincmd('p')
  vim.api.nvim_input('u')
  becomes('undo restores that text', 'unsaved\n', shown)
  vim.cmd.bwipeout({ bang = true })
end

local function other_texts()
  local crlf = TYPO:gsub('\n', '\r\n')
  write('windows.pyr', crlf)
  open('windows.pyr')
  becomes('with Windows line ends, the error has the same range', unknown(), errors)
  go_to('whelR')
  act('wheelR')
  becomes('and is fixed', {}, errors)
  vim.cmd.write()
  check('the line ends are kept', read('windows.pyr') == FIXED:gsub('\n', '\r\n'), read('windows.pyr'))

  -- A car has four UTF-8 bytes, two UTF-16 units and one character.
  local comment = '/* 🚗 */ '
  write('emoji.pyr', (TYPO:gsub('robot robot_1', comment .. '%0')))
  open('emoji.pyr')
  becomes('after an emoji, the error has the right range', unknown(#comment), errors)
  vim.lsp.enable('pydslrep', false)
  wait(function() return not client() end)
  local capabilities = vim.lsp.protocol.make_client_capabilities()
  capabilities.general.positionEncodings = { 'utf-16' }
  vim.lsp.config('pydslrep', { capabilities = capabilities })
  vim.lsp.enable('pydslrep')
  open('emoji.pyr')
  check('columns can be counted in UTF-16', client().offset_encoding == 'utf-16', client().offset_encoding)
  becomes('with the same range', unknown(#comment), errors)
  go_to('whelR')
  act('wheelR')
  becomes('and the same fix', (FIXED:gsub('robot robot_1', comment .. '%0')), text)
end

local function life()
  open('typo.pyr')
  local first = process()
  vim.uv.kill(first, 'sigkill')
  check('a killed server is noticed', wait(function() return not client() end))
  open('typo.pyr')
  check('and restarted with the next file', client() and process() ~= first)
  if vim.fn.exists(':lsp') == 2 then
    local second = client().id
    vim.cmd('lsp restart')
    local function restarted() return client() and client().initialized and client().id ~= second end
    check('the server can be restarted', wait(restarted))
  end
  vim.api.nvim_buf_set_lines(0, 0, 1, false, {})
  becomes('and responds', 'unresolved-reference', function() return (errors()[1] or {})[5] end)
  write('../server.pid', tostring(process()))
end

harness.run({
  diagnostics, no_script_of_a_broken_program, completion, reading, beside_the_program, while_typing,
  rewriting, renaming, formatting, files_that_move, two_windows,
  settings_file, quick_fix, script, other_texts, life,
})
