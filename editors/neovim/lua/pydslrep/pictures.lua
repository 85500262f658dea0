--- Opens what the server shows outside Neovim: pictures, and the page of the live preview.

local config = require('pydslrep.config')
local notify = require('pydslrep.notify')

local M = {}

--- Opens something outside Neovim; if that fails, a warning names it.
---@param what string
---@param path string A file or an address.
---@param custom? fun(path: string) Opens it instead of the system.
---@return boolean
local function open(what, path, custom)
  local started, why
  if custom then
    started, why = pcall(custom, path)
  else
    started, why = vim.ui.open(path)
  end
  if not started then
    notify.warning(('cannot open %s (%s): %s'):format(what, why, path))
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
    return { success = open('the picture', vim.uri_to_fname(params.uri), config.get().open) }
  elseif params.external then
    -- The command that opens the preview prints the address, whatever comes of this.
    pcall(vim.ui.open, params.uri)
    return { success = true }
  end
  return vim.lsp.handlers['window/showDocument'](problem, params, context, ...)
end

return M
