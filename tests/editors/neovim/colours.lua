-- Tests that the syntax file, the parser and the server give programs the same colours. run.sh starts it in an empty
-- folder, with the server disabled.

local harness = dofile(vim.env.TESTS .. '/harness.lua')
local wait, check, notified = harness.wait, harness.check, harness.notified

-- Everything in the grammar that the article's programs do not use.
local EVERYTHING = [[
import "parts/rover.pyr"
// A comment, TODO: with a robot { in it }
/* one of
   several lines: wheel w with radius 1 */
wheelH ^robots with radius 4.5
wheelH b with radius 10
sensor distance : distance
sensor bumper: bumper
sensor import
ip home 127.0.0.1
robot first type fwh with port 20000 has { ^robots, b, ^robots, b } wheels with sensors { distance bumper, import }
robot second with port 20001 has { /* none } */ b b } wheels
parallel movement m of first {
  move -1.5 meters at 12
  turn left 30 turn right until { distance, bumper } // and on
  slam
}
movement n of second { turn left }
movement if of first {
  repeat until { distance import } detect within 40 centimeters {
    if { import } clear { do ^repeat } else if { bumper } detect { turn right with radius 2 meters in reverse } else {
      wait 2.5 seconds until { bumper } clear
      do if do
        do
    }
  }
  repeat 4 times { wait until { distance } detect }
}
environment e with ip home has { first, second } robots with { m, n } moves
environment f has { first } robots
]]

local function programs()
  harness.write('everything.pyr', EVERYTHING)
  local found = { 'everything.pyr' }
  for _, folder in ipairs({ '/tests/paper/*.pyr', '/examples/*.pyr', '/examples/parts/*.pyr' }) do
    vim.list_extend(found, vim.fn.glob(vim.env.REPOSITORY .. folder, true, true))
  end
  return found
end

--- The visible colour of stacked groups, and the last group with a colour.
local function visible(groups)
  local colour, name = {}, nil
  for _, group in ipairs(groups) do
    local own = vim.api.nvim_get_hl(0, { name = group, link = false })
    if next(own) then
      colour = vim.tbl_extend('force', colour, own)
      name = group
    end
  end
  return name and { colour = colour, group = name } or nil
end

local WAYS = {
  syntax = function(found) return vim.tbl_map(function(item) return item.hl_group end, found.syntax) end,
  treesitter = function(found)
    local own = vim.tbl_filter(function(item) return item.lang == 'pydslrep' end, found.treesitter)
    return vim.tbl_map(function(item) return item.hl_group end, own)
  end,
  semantic_tokens = function(found)
    table.sort(found.semantic_tokens, function(a, b) return a.opts.priority < b.opts.priority end)
    return vim.tbl_map(function(item) return item.opts.hl_group end, found.semantic_tokens)
  end,
}

--- The groups of each visible character of a program, by its position.
local function colours(program, way)
  vim.cmd.edit(program)
  if way == 'treesitter' then
    assert(vim.treesitter.highlighter.active[vim.api.nvim_get_current_buf()], 'tree-sitter does not colour')
    vim.treesitter.get_parser(0):parse()
  elseif way == 'semantic_tokens' then
    wait(function() return vim.lsp.semantic_tokens.get_at_pos(0, vim.fn.line('$') - 1, 0) end)
    wait(function() return #vim.inspect_pos(0, 0, 0).semantic_tokens > 0 end)
  end
  local all = {}
  for row, line in ipairs(vim.api.nvim_buf_get_lines(0, 0, -1, false)) do
    for column in line:gmatch('()%S') do
      all[row .. ':' .. column] = WAYS[way](vim.inspect_pos(0, row - 1, column - 1))
    end
  end
  return all
end

--- Where two ways to highlight a program differ.
local function differences(program, before, after)
  local found = {}
  for place, groups in pairs(after) do
    local one, other = visible(groups), visible(before[place])
    -- The server has no colour for punctuation; others may.
    local stays = #groups == 0 and (before[place][1] or ''):find('^@punctuation')
    if not stays and not vim.deep_equal(one and one.colour, other and other.colour) then
      table.insert(found, { program, place, one and one.group or 'nothing', other and other.group or 'nothing' })
    end
  end
  return found
end

-- Neovim requests semantic tokens of visible lines only.
vim.o.lines = 400

local of = { syntax = {}, treesitter = {}, semantic_tokens = {} }

local function read(way)
  for _, program in ipairs(programs()) do
    of[way][program] = colours(program, way)
  end
end

local function by_the_syntax_file()
  local parser = require('pydslrep.parser')
  vim.fn.mkdir(vim.fs.dirname(parser.path()), 'p')
  harness.write(parser.path(), 'no parser')
  read('syntax')
  check('an invalid parser is ignored', vim.bo.syntax == 'pydslrep')
  vim.cmd.checkhealth('pydslrep')
  check('and reported', harness.text():find('cannot be used', 1, true), harness.text())
  vim.cmd.bwipeout()
  vim.uv.fs_unlink(parser.path())
end

local function by_the_parser()
  local nothing = notified('no grammar in', function() vim.cmd('Pydslrep parser /nowhere') end)
  check('a missing grammar is reported', nothing)
  local compiler = vim.env.CC
  vim.env.CC = 'false'
  check('a failing compiler is reported', notified('failed to build', function() vim.cmd('Pydslrep parser') end))
  vim.env.CC = compiler
  check('the parser is built', notified('built ', function() vim.cmd('Pydslrep parser') end))
  check('and used at once', vim.treesitter.highlighter.active[vim.api.nvim_get_current_buf()])
  vim.cmd.checkhealth('pydslrep')
  check('health finds it', harness.text():find('parser/pydslrep.so', 1, true), harness.text())
  vim.cmd.bwipeout()
  vim.cmd('silent %bwipeout')
  read('treesitter')
  local method = vim.wo.foldmethod .. ' ' .. vim.wo.foldexpr
  check('it folds', method == 'expr v:lua.vim.treesitter.foldexpr()', method)
  vim.cmd.edit(vim.env.PROGRAM)
  harness.becomes('movements', 1, function() return vim.fn.foldlevel(8) end)
end

local function by_the_server()
  vim.cmd('silent %bwipeout')
  vim.lsp.enable('pydslrep')
  read('semantic_tokens')
  local kinds, places = {}, 0
  for _, all in pairs(of.semantic_tokens) do
    for _, groups in pairs(all) do
      for _, group in ipairs(groups) do
        kinds[group:match('@lsp%.type%.(%w+)') or kinds] = true
      end
      places = places + math.min(1, #groups)
    end
  end
  kinds[kinds] = nil
  local names = vim.tbl_keys(kinds)
  table.sort(names)
  local all = { 'class', 'comment', 'enumMember', 'function', 'keyword', 'namespace', 'number', 'property', 'string',
    'variable' }
  check('the server has all types of tokens', vim.deep_equal(names, all), names)
  check('at many positions', places > 3000, places)
  for _, scheme in ipairs({ 'default', 'habamax', 'catppuccin' }) do
    vim.cmd.colorscheme(scheme)
    for _, way in ipairs({ 'syntax', 'treesitter' }) do
      local found = {}
      for program, after in pairs(of.semantic_tokens) do
        vim.list_extend(found, differences(program, of[way][program], after))
      end
      local what = ('semantic tokens change no colour: %s, %s'):format(scheme, way)
      check(what, #found == 0, vim.list_slice(found, 1, 40))
    end
  end
  vim.cmd.edit(vim.env.PROGRAM)
  wait(function() return harness.client() end)
  local first = harness.client().id
  vim.cmd('Pydslrep restart')
  local function restarted()
    return harness.client() and harness.client().initialized and harness.client().id ~= first
  end
  check('the plugin restarts a server that it did not start', wait(restarted))
  harness.write('../server.pid', tostring(harness.process()))
end

harness.run({ by_the_syntax_file, by_the_parser, by_the_server })
