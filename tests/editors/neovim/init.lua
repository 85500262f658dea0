-- For the session `package`: only options, since Neovim loads packages by itself.
vim.g.pydslrep = {
  settings = { severity = { ['unused-declaration'] = 'off' } },
  open = function(picture)
    _G.opened = picture
  end,
}
