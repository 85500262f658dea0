-- blink.cmp with default settings and the key preset in `vim.g.typing_variant`.
require('blink.cmp').setup({
  keymap = { preset = vim.g.typing_variant },
  -- The default is a native library, which is not installed.
  fuzzy = { implementation = 'lua' },
})
