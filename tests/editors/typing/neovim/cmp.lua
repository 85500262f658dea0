-- nvim-cmp with the keys of its readme; `vim.g.typing_variant` says whether Enter accepts the first item if none is
-- selected.
local cmp = require('cmp')
cmp.setup({
  mapping = cmp.mapping.preset.insert({
    ['<C-Space>'] = cmp.mapping.complete(),
    ['<CR>'] = cmp.mapping.confirm({ select = vim.g.typing_variant == 'select' }),
    ['<Tab>'] = cmp.mapping(function(fallback)
      if cmp.visible() then cmp.select_next_item() else fallback() end
    end, { 'i' }),
  }),
  sources = { { name = 'nvim_lsp' } },
})
vim.lsp.config('*', { capabilities = require('cmp_nvim_lsp').default_capabilities() })
