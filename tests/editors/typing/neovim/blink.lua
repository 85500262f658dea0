-- blink.cmp as it comes, with its preset of keys that `vim.g.typing_variant` names.
require('blink.cmp').setup({
  keymap = { preset = vim.g.typing_variant },
  -- The other one is a library that is not there.
  fuzzy = { implementation = 'lua' },
})
