--- `:Pydslrep`: one command, with a word for each thing it does.

local pydslrep = require('pydslrep')
local say = require('pydslrep.say')

local M = {}

---@class pydslrep.Subcommand
---@field takes? 'environment'|'dir' What may follow it.
---@field act fun(argument?: string)

---@type table<string, pydslrep.Subcommand>
local subcommands = {
  generate = { takes = 'environment', act = pydslrep.generate },
  run = { takes = 'environment', act = pydslrep.run },
  preview = { takes = 'environment', act = pydslrep.preview },
  parser = { takes = 'dir', act = pydslrep.parser },
  stop = { act = pydslrep.stop },
  restart = { act = pydslrep.restart },
  log = { act = pydslrep.log },
  health = { act = function() vim.cmd.checkhealth('pydslrep') end },
}

---@return string[]
local function names()
  local all = vim.tbl_keys(subcommands)
  table.sort(all)
  return all
end

--- The names of the environments of the current buffer.
---@return string[]
local function environments()
  local found = {}
  for _, line in ipairs(vim.api.nvim_buf_get_lines(0, 0, -1, false)) do
    for name in line:gmatch('%f[%w_]environment%s+%^?([%a_][%w_]*)') do
      table.insert(found, name)
    end
  end
  return found
end

---@param typed string
---@param line string
---@return string[]
function M.complete(typed, line)
  local before = vim.split(line:sub(1, #line - #typed), '%s+', { trimempty = true })
  local offered = {}
  if #before == 1 then
    offered = names()
  elseif #before == 2 then
    local takes = (subcommands[before[2]] or {}).takes
    if takes == 'dir' then
      return vim.fn.getcompletion(typed, 'dir')
    end
    offered = takes == 'environment' and environments() or {}
  end
  return vim.tbl_filter(function(word) return vim.startswith(word, typed) end, offered)
end

---@param arguments string[]
function M.run(arguments)
  local name, argument = arguments[1], arguments[2]
  local subcommand = subcommands[name]
  if not subcommand then
    local said = name and ('there is no `:Pydslrep %s`'):format(name) or '`:Pydslrep` is to be followed by a word'
    say.error(('%s; there are: %s'):format(said, table.concat(names(), ', ')))
  elseif #arguments > (subcommand.takes and 2 or 1) then
    say.error(('`:Pydslrep %s` takes %s'):format(name, subcommand.takes and 'one word only' or 'nothing more'))
  else
    subcommand.act(argument)
  end
end

return M
