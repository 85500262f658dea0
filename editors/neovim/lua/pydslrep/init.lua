--- The Lua API of the plugin. Nothing needs to be called: `setup` only sets options.

local M = {}

--- Sets options, like `vim.g.pydslrep = options` before the first program is opened.
---@param options? pydslrep.Options
function M.setup(options)
  vim.g.pydslrep = options or {}
  local problems = require('pydslrep.config').problems(vim.g.pydslrep)
  if #problems > 0 then
    require('pydslrep.notify').warning('options: ' .. table.concat(problems, '; '))
  end
  require('pydslrep.server').enable()
end

--- Writes the script of an environment; without a name, of the one at the cursor or one chosen from a list.
---@param environment? string
function M.generate(environment)
  require('pydslrep.runs').start('pydslrep.generateScript', environment)
end

--- Runs an environment in the embedded simulator.
---@param environment? string
function M.run(environment)
  require('pydslrep.runs').start('pydslrep.run', environment)
end

--- Draws an environment's planned path and opens the picture.
---@param environment? string
function M.preview(environment)
  require('pydslrep.runs').start('pydslrep.previewPath', environment)
end

--- Builds an environment's scene in a running CoppeliaSim; asks before it replaces what it built before.
---@param environment? string
function M.push(environment)
  require('pydslrep.runs').start('pydslrep.pushScene', environment)
end

--- Checks the scene of a running CoppeliaSim against an environment.
---@param environment? string
function M.check(environment)
  require('pydslrep.runs').start('pydslrep.checkScene', environment)
end

--- Removes what `push` has built for an environment.
---@param environment? string
function M.remove(environment)
  require('pydslrep.runs').start('pydslrep.removeScene', environment)
end

--- Opens the live preview in a browser: the planned path, which follows the text and the cursor.
---@param environment? string
function M.live(environment)
  require('pydslrep.live').open(environment)
end

--- Stops the run.
function M.stop()
  require('pydslrep.runs').stop()
end

--- Restarts the server.
function M.restart()
  require('pydslrep.server').restart()
end

--- Opens the log of the language servers.
function M.log()
  require('pydslrep.server').log()
end

--- Builds the tree-sitter parser.
---@param grammar? string The grammar's folder.
function M.parser(grammar)
  require('pydslrep.parser').install(grammar)
end

return M
