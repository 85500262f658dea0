--- The command `:Pydslrep` and its subcommands.

local pydslrep = require('pydslrep')
local notify = require('pydslrep.notify')

local M = {}

---@class pydslrep.Subcommand
---@field argument? 'environment'|'dir' The kind of its optional argument.
---@field execute fun(argument?: string)

---@type table<string, pydslrep.Subcommand>
local subcommands = {
  generate = { argument = 'environment', execute = pydslrep.generate },
  run = { argument = 'environment', execute = pydslrep.run },
  preview = { argument = 'environment', execute = pydslrep.preview },
  push = { argument = 'environment', execute = pydslrep.push },
  check = { argument = 'environment', execute = pydslrep.check },
  remove = { argument = 'environment', execute = pydslrep.remove },
  parser = { argument = 'dir', execute = pydslrep.parser },
  stop = { execute = pydslrep.stop },
  restart = { execute = pydslrep.restart },
  log = { execute = pydslrep.log },
  health = { execute = function() vim.cmd.checkhealth('pydslrep') end },
}

---@return string[]
local function names()
  local all = vim.tbl_keys(subcommands)
  table.sort(all)
  return all
end

---@param words string[]
---@param typed string
---@return string[]
local function matching(words, typed)
  return vim.tbl_filter(function(word) return vim.startswith(word, typed) end, words)
end

--- The names of the environments of the current buffer that begin like this.
---@param typed string
---@return string[]
function M.environments(typed)
  local found = {}
  for _, line in ipairs(vim.api.nvim_buf_get_lines(0, 0, -1, false)) do
    for name in line:gmatch('%f[%w_]environment%s+%^?([%a_][%w_]*)') do
      table.insert(found, name)
    end
  end
  return matching(found, typed)
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
    local kind = (subcommands[before[2]] or {}).argument
    if kind == 'dir' then
      return vim.fn.getcompletion(typed, 'dir')
    end
    return kind == 'environment' and M.environments(typed) or {}
  end
  return matching(offered, typed)
end

---@param arguments string[]
function M.run(arguments)
  local name, argument = arguments[1], arguments[2]
  local subcommand = subcommands[name]
  if not subcommand then
    local problem = name and ('unknown subcommand `%s`'):format(name) or 'missing subcommand'
    notify.error(('%s; use one of: %s'):format(problem, table.concat(names(), ', ')))
  elseif #arguments > (subcommand.argument and 2 or 1) then
    notify.error(('`:Pydslrep %s` takes %s'):format(name, subcommand.argument and 'one argument' or 'no argument'))
  else
    subcommand.execute(argument)
  end
end

return M
