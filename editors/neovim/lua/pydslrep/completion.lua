--- Completion plugins: no menu is open at a word that is typed in full, where Enter would take it instead of ending the
--- line. Neovim's own completion asks the server after each letter, and needs nothing.

local M = {}

--- Fewer letters are typed as fast as they are completed.
local MISSING = 2

--- Leaves out of nvim-cmp's menu what is as good as typed. It keeps what it has where the server has nothing more.
local function narrow_cmp()
  local cmp = package.loaded['cmp']
  if not cmp then
    return
  end
  local sources = vim.deepcopy(cmp.get_config().sources)
  for _, source in ipairs(sources) do
    local own = source.entry_filter
    source.entry_filter = function(entry, context)
      local typed = context.cursor_before_line:sub(entry.offset)
      return #entry.word - #typed >= MISSING and (not own or own(entry, context))
    end
  end
  cmp.setup.buffer({ sources = sources })
end

--- Leaves out words of the buffer, which blink.cmp has where the server has nothing; a choice of the person's stays.
local function narrow_blink()
  local blink = package.loaded['blink.cmp.config']
  if blink and blink.sources.per_filetype.pydslrep == nil then
    blink.sources.per_filetype.pydslrep = { 'lsp', 'path', 'snippets' }
  end
end

--- For a program; plugins may be loaded with the first insertion only.
---@param buffer integer
function M.narrow(buffer)
  vim.api.nvim_create_autocmd('InsertEnter', {
    buffer = buffer,
    once = true,
    callback = function()
      narrow_cmp()
      narrow_blink()
    end,
  })
end

return M
