-- The configuration of the language server, read by `vim.lsp.enable('pydslrep')`.
return require('pydslrep.server').config()
