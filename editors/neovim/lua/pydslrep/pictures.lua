--- Opens pictures that the server has drawn.

local config = require('pydslrep.config')
local notify = require('pydslrep.notify')

local M = {}

--- Opens a picture outside Neovim; if that fails, a warning names its file.
---@param path string
---@return boolean
local function open(path)
  local custom = config.get().open
  local started, why
  if custom then
    started, why = pcall(custom, path)
  else
    started, why = vim.ui.open(path)
  end
  if not started then
    notify.warning(('cannot open the picture (%s): %s'):format(why, path))
    return false
  end
  return true
end

--- Handles `window/showDocument`. Neovim's own handler waits for the viewer and then kills it.
---@param problem lsp.ResponseError?
---@param params lsp.ShowDocumentParams
---@param context lsp.HandlerContext
function M.show_document(problem, params, context, ...)
  if params.external and vim.startswith(params.uri, 'file:') then
    return { success = open(vim.uri_to_fname(params.uri)) }
  end
  return vim.lsp.handlers['window/showDocument'](problem, params, context, ...)
end

return M
