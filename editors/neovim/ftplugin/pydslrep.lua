-- Options for programs; see `:help pydslrep-filetype`.
if vim.b.did_ftplugin then
  return
end
vim.b.did_ftplugin = 1

local buffer = vim.api.nvim_get_current_buf()
local options = vim.bo[buffer]
options.commentstring = '// %s'
options.comments = 's1:/*,mb:*,ex:*/,://'
options.formatoptions = options.formatoptions:gsub('t', '') .. 'croql'
options.expandtab, options.shiftwidth, options.softtabstop = true, 2, 2
options.suffixesadd = '.pyr'
options.include = [[^\s*import\s*"]]
vim.b.undo_ftplugin = 'setlocal commentstring< comments< formatoptions< expandtab< shiftwidth< softtabstop<'
  .. ' suffixesadd< include< foldmethod< foldexpr< foldlevel< | lua pcall(vim.treesitter.stop)'

local has_parser = require('pydslrep.parser').highlight(buffer)
require('pydslrep.folding').open(buffer, has_parser)
require('pydslrep.server').warn_if_missing()
require('pydslrep.completion').configure(buffer)
