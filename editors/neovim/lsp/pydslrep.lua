-- The language server of PyDSLRep; `vim.lsp.enable('pydslrep')` reads this file.
return require('pydslrep.server').config()
