--- The live preview: a page in a browser, which the server serves. The server learns from requests where the cursor is;
--- Neovim sends none when it moves.

local notify = require('pydslrep.notify')
local server = require('pydslrep.server')

local M = {}

--- Tells the server where the cursor is in the current buffer.
local function tell_cursor()
  local buffer = vim.api.nvim_get_current_buf()
  local client = server.clients({ bufnr = buffer })[1]
  if client and vim.bo[buffer].filetype == 'pydslrep' then
    local params = vim.lsp.util.make_position_params(0, client.offset_encoding)
    server.request(client, 'pydslrep/plannedAt', params, function() end, buffer)
  end
end

--- Opens the page; without a name, it shows the environment at the cursor.
---@param environment? string
function M.open(environment)
  local buffer = vim.api.nvim_get_current_buf()
  local client = server.client(buffer)
  if not client then
    return
  end
  tell_cursor()
  local shown = { uri = vim.uri_from_bufnr(buffer), environment = environment }
  local params = { command = 'pydslrep.openPreview', arguments = { shown } }
  server.request(client, 'workspace/executeCommand', params, function(problem, opened)
    if problem then
      notify.error(problem.message)
    elseif type(opened) == 'table' and opened.address then
      -- Whether a browser opens it, nobody can tell: the system's opener may find none, or one on another screen.
      notify.info('path preview: ' .. opened.address)
    end
  end, buffer)
  vim.api.nvim_create_autocmd({ 'BufEnter', 'CursorMoved', 'CursorMovedI' }, {
    group = vim.api.nvim_create_augroup('pydslrep_live', {}),
    callback = tell_cursor,
  })
end

return M
