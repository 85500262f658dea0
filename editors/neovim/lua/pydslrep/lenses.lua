--- The commands of code lenses (`grx`).

local runs = require('pydslrep.runs')

local M = {}

--- Lists references; the command's arguments are a URI, a position and locations.
---@param command lsp.Command
---@param context { client_id: integer }
local function show_references(command, context)
  local client = vim.lsp.get_client_by_id(context.client_id)
  if client then
    local items = vim.lsp.util.locations_to_items(command.arguments[3], client.offset_encoding)
    vim.fn.setqflist({}, ' ', { title = 'References', items = items })
    vim.cmd('botright copen')
  end
end

--- Registers the commands in Neovim, which would otherwise ignore the server's answer.
function M.register()
  vim.lsp.commands['pydslrep.showReferences'] = show_references
  for _, name in ipairs({ 'pydslrep.generateScript', 'pydslrep.run', 'pydslrep.previewPath' }) do
    vim.lsp.commands[name] = function(command, context)
      local client = vim.lsp.get_client_by_id(context.client_id)
      if client then
        runs.execute(client, context.bufnr, name, command.arguments[1])
      end
    end
  end
end

return M
