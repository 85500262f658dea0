-- The language server of PyDSLRep; `vim.lsp.enable('pydslrep')` reads this file.
return {
  cmd = { 'pydslrep-lsp', '--stdio' },
  filetypes = { 'pydslrep', 'toml' },
  root_dir = function(buffer, use)
    -- Of all the TOML there is, only its own settings are the server's business.
    local name = vim.fs.basename(vim.api.nvim_buf_get_name(buffer))
    if vim.bo[buffer].filetype == 'pydslrep' or name == 'pydslrep.toml' then
      use(vim.fs.root(buffer, { 'pydslrep.toml', '.git' }))
    end
  end,
}
