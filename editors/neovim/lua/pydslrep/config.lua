--- What a person can set, in `vim.g.pydslrep` or by `require('pydslrep').setup()`; `:help pydslrep-options`.

---@class pydslrep.Options
---@field cmd? string[] How the server is started; by default whatever is found.
---@field settings? table What docs/configuration.md names, e.g. `{ severity = { ['wheel-order'] = 'off' } }`.
---@field enable? boolean Whether the server starts with the first program.
---@field highlight? boolean Whether tree-sitter colours programs where its parser is there.
---@field folding? boolean Whether programs can be folded, all open at first.
---@field grammar? string The folder of the tree-sitter grammar that `:Pydslrep parser` builds.
---@field open? fun(picture: string) What opens a picture; by default what the system has for it.

local M = {}

---@type pydslrep.Options
local defaults = { settings = {}, enable = true, highlight = true, folding = true }

local types = {
  cmd = 'table',
  settings = 'table',
  enable = 'boolean',
  highlight = 'boolean',
  folding = 'boolean',
  grammar = 'string',
  open = 'function',
}

--- What is wrong with the options, one line for each.
---@param options any
---@return string[]
function M.problems(options)
  if type(options) ~= 'table' then
    return { 'the options are to be a table, not a ' .. type(options) }
  end
  local found = {}
  for key, value in pairs(options) do
    local wanted = types[key]
    if not wanted then
      local known = vim.tbl_keys(types)
      table.sort(known)
      table.insert(found, ('there is no option `%s`; there are: %s'):format(key, table.concat(known, ', ')))
    elseif type(value) ~= wanted then
      table.insert(found, ('`%s` is to be a %s, not a %s'):format(key, wanted, type(value)))
    end
  end
  table.sort(found)
  return found
end

--- The options as they are now: what is wrong counts as not set.
---@return pydslrep.Options
function M.get()
  local options = vim.deepcopy(defaults)
  local chosen = vim.g.pydslrep
  for key, value in pairs(type(chosen) == 'table' and chosen or {}) do
    if types[key] == type(value) then
      options[key] = value
    end
  end
  return options
end

return M
