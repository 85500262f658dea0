-- Of the session `package`: options, and nothing to load the plugin, which is a package.
vim.g.pydslrep = {
  settings = { severity = { ['unused-declaration'] = 'off' } },
  open = function(picture)
    _G.opened = picture
  end,
}
