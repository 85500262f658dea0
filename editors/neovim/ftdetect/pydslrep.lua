vim.filetype.add({ extension = { pyr = 'pydslrep' } })
