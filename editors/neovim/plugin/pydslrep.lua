-- Loaded at startup; everything else is loaded on demand.
if vim.g.loaded_pydslrep or vim.fn.has('nvim-0.10') == 0 then
  return
end
vim.g.loaded_pydslrep = true

vim.api.nvim_create_user_command('Pydslrep', function(call)
  require('pydslrep.command').run(call.fargs)
end, {
  nargs = '*',
  desc = 'PyDSLRep: scripts, runs, previews, and the server',
  complete = function(typed, line)
    return require('pydslrep.command').complete(typed, line)
  end,
})

vim.api.nvim_create_user_command('PydslrepPreview', function(call)
  require('pydslrep').live(call.fargs[1])
end, {
  nargs = '?',
  desc = 'PyDSLRep: the planned path in a browser, live',
  complete = function(typed)
    return require('pydslrep.command').environments(typed)
  end,
})

local group = vim.api.nvim_create_augroup('pydslrep', {})

---@param event string
---@param handle fun(event: table)
local function on_server(event, handle)
  vim.api.nvim_create_autocmd(event, {
    group = group,
    callback = function(details)
      local client = vim.lsp.get_client_by_id(details.data.client_id)
      if client and client.name == 'pydslrep' then
        handle(details)
      end
    end,
  })
end

on_server('LspAttach', function(event)
  require('pydslrep.lenses').register()
  if vim.bo[event.buf].filetype == 'pydslrep' then
    require('pydslrep.cursor').attached(event.buf)
    require('pydslrep.folding').attached(event.buf)
  end
end)
on_server('LspProgress', function(event)
  require('pydslrep.runs').progressed(event.data)
end)

-- nvim-treesitter drops parsers that others have registered whenever it reloads its list.
vim.api.nvim_create_autocmd('User', {
  group = group,
  pattern = 'TSUpdate',
  callback = function()
    local installed, parsers = pcall(require, 'nvim-treesitter.parsers')
    if installed and type(parsers) == 'table' then
      parsers.pydslrep = { install_info = { path = require('pydslrep.parser').grammar() } }
    end
  end,
})

require('pydslrep.colours').link()
require('pydslrep.server').enable()
