-- The language server of PyDSLRep; `vim.lsp.enable('pydslrep')` reads this file.
return {
  cmd = { 'pydslrep-lsp', '--stdio' },
  filetypes = { 'pydslrep', 'toml' },
  root_dir = function(buffer, use)
    -- Of all the TOML there is, only its own settings and scenes are the server's business.
    local name = vim.fs.basename(vim.api.nvim_buf_get_name(buffer))
    local is_ours = name == 'pydslrep.toml' or vim.endswith(name, '.scene.toml')
    if vim.bo[buffer].filetype == 'pydslrep' or is_ours then
      use(vim.fs.root(buffer, { 'pydslrep.toml', '.git' }))
    end
  end,
}
