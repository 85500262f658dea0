--- The options, set in `vim.g.pydslrep` or with `require('pydslrep').setup()`; see `:help pydslrep-options`.

---@class pydslrep.Options
---@field cmd? string[] The command that starts the server; found automatically by default.
---@field settings? table The settings of docs/configuration.md, e.g. `{ severity = { ['wheel-order'] = 'off' } }`.
---@field enable? boolean Whether the server starts with the first program.
---@field highlight? boolean Whether to highlight with tree-sitter if its parser is installed.
---@field folding? boolean Whether to set up folding, with all folds open.
---@field grammar? string The folder of the tree-sitter grammar that `:Pydslrep parser` builds.
---@field open? fun(picture: string) Opens a picture; by default with the system's viewer.

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

--- The problems of the options, one line each.
---@param options any
---@return string[]
function M.problems(options)
  if type(options) ~= 'table' then
    return { 'the options must be a table, not a ' .. type(options) }
  end
  local found = {}
  for key, value in pairs(options) do
    local wanted = types[key]
    if not wanted then
      local known = vim.tbl_keys(types)
      table.sort(known)
      table.insert(found, ('unknown option `%s`; use one of: %s'):format(key, table.concat(known, ', ')))
    elseif type(value) ~= wanted then
      table.insert(found, ('`%s` must be a %s, not a %s'):format(key, wanted, type(value)))
    end
  end
  table.sort(found)
  return found
end

--- The current options; invalid ones have their defaults.
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
