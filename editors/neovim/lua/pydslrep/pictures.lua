--- Pictures that the server has drawn, and how they are opened.

local config = require('pydslrep.config')
local say = require('pydslrep.say')

local M = {}

--- Opens a picture outside Neovim; where nothing can, it says where it is.
---@param path string
---@return boolean
local function open(path)
  local set = config.get().open
  local started, why
  if set then
    started, why = pcall(set, path)
  else
    started, why = vim.ui.open(path)
  end
  if not started then
    say.warning(('nothing opens the picture (%s); it is %s'):format(why, path))
    return false
  end
  return true
end

--- `window/showDocument`. Neovim's own handler waits for the viewer and then kills it.
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
