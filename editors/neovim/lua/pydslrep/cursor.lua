--- The problems of a statement that is being typed are shown once its line is left. The server learns that from
--- requests; Neovim sends none when the cursor moves.

local server = require('pydslrep.server')

local M = {}

---@param buffer integer
local function tell(buffer)
  local client = server.clients({ bufnr = buffer })[1]
  if client then
    local params = vim.lsp.util.make_position_params(0, client.offset_encoding)
    server.request(client, 'textDocument/documentHighlight', params, function() end, buffer)
  end
end

--- Tells the server whenever the cursor comes to another line of a buffer.
---@param buffer integer
function M.attached(buffer)
  local before
  vim.api.nvim_create_autocmd({ 'CursorMoved', 'CursorMovedI' }, {
    group = vim.api.nvim_create_augroup('pydslrep_cursor_' .. buffer, {}),
    buffer = buffer,
    callback = function()
      local line = vim.api.nvim_win_get_cursor(0)[1]
      if line ~= before then
        before = line
        tell(buffer)
      end
    end,
  })
end

return M
