-- The language server of PyDSLRep; `vim.lsp.enable('pydslrep')` reads this file.
return {
  cmd = { 'pydslrep-lsp', '--stdio' },
  filetypes = { 'pydslrep' },
  root_markers = { 'pydslrep.toml', '.git' },
}
