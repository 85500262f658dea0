--- What the lenses above declarations do when they are run (`grx`).

local runs = require('pydslrep.runs')

local M = {}

--- Lists references; the command's arguments are an address, a position and the places.
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

--- Makes the commands known to Neovim, which otherwise passes them to the server and forgets the answer.
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
