--- Keeps the menus of completion plugins closed at complete words, where Enter would accept an item instead of ending
--- the line. Neovim's own completion asks the server after each letter and needs no such filter.

local M = {}

--- Items that would add fewer letters are hidden: typing them is as fast.
local MIN_ADDED = 2

--- Filters nvim-cmp's items, which it keeps when the server has no more.
local function configure_cmp()
  local cmp = package.loaded['cmp']
  if not cmp then
    return
  end
  local sources = vim.deepcopy(cmp.get_config().sources)
  for _, source in ipairs(sources) do
    local filter = source.entry_filter
    source.entry_filter = function(entry, context)
      local typed = context.cursor_before_line:sub(entry.offset)
      return #entry.word - #typed >= MIN_ADDED and (not filter or filter(entry, context))
    end
  end
  cmp.setup.buffer({ sources = sources })
end

--- Removes blink.cmp's words of the buffer and its paths, unless the user has set its sources. The server offers the
--- names and files that fit; after `*/`, a path would be in the root directory.
local function configure_blink()
  local blink = package.loaded['blink.cmp.config']
  if blink and blink.sources.per_filetype.pydslrep == nil then
    blink.sources.per_filetype.pydslrep = { 'lsp', 'snippets' }
  end
end

--- Configures the plugins for a program; they may be loaded only when inserting starts.
---@param buffer integer
function M.configure(buffer)
  vim.api.nvim_create_autocmd('InsertEnter', {
    buffer = buffer,
    once = true,
    callback = function()
      configure_cmp()
      configure_blink()
    end,
  })
end

return M
