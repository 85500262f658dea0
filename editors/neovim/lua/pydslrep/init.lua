--- PyDSLRep in Neovim. Nothing has to be called: the plugin works as it is, and `setup` only sets options.

local M = {}

--- Sets options; the same as `vim.g.pydslrep = options` before the first program is opened.
---@param options? pydslrep.Options
function M.setup(options)
  vim.g.pydslrep = options or {}
  local problems = require('pydslrep.config').problems(vim.g.pydslrep)
  if #problems > 0 then
    require('pydslrep.say').warning('options: ' .. table.concat(problems, '; '))
  end
  require('pydslrep.server').enable()
end

--- Writes the script of an environment; of the only one, or of the one that is chosen.
---@param environment? string
function M.generate(environment)
  require('pydslrep.runs').start('pydslrep.generateScript', environment)
end

--- Drives an environment in the embedded simulator.
---@param environment? string
function M.run(environment)
  require('pydslrep.runs').start('pydslrep.run', environment)
end

--- Draws an environment's planned path, and opens the picture.
---@param environment? string
function M.preview(environment)
  require('pydslrep.runs').start('pydslrep.previewPath', environment)
end

--- Stops what runs.
function M.stop()
  require('pydslrep.runs').stop()
end

--- Starts the server again.
function M.restart()
  require('pydslrep.server').restart()
end

--- Opens what the server and its protocol have logged.
function M.log()
  require('pydslrep.server').log()
end

--- Builds the tree-sitter parser.
---@param grammar? string Its folder.
function M.parser(grammar)
  require('pydslrep.parser').install(grammar)
end

return M
