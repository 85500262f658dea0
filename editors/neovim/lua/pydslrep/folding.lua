--- Sets up folding: by the server if attached, or else by tree-sitter or the syntax file.

local config = require('pydslrep.config')

local M = {}

--- Whether the user has set no other folding.
---@return boolean
local function is_enabled()
  return config.get().folding and vim.go.foldmethod == 'manual'
end

---@param window integer
---@param method string
---@param expression? string
local function use(window, method, expression)
  local options = vim.wo[window][0]
  options.foldmethod = method
  if expression then
    options.foldexpr = expression
  end
  -- Unless the user has set it otherwise, all folds are open.
  if vim.go.foldlevelstart < 0 and vim.go.foldlevel == 0 and options.foldlevel == 0 then
    options.foldlevel = 99
  end
end

--- Folds a newly opened program, before the server is attached.
---@param buffer integer
---@param has_parser boolean
function M.open(buffer, has_parser)
  if not is_enabled() then
    return
  end
  for _, window in ipairs(vim.fn.win_findbuf(buffer)) do
    if has_parser then
      use(window, 'expr', 'v:lua.vim.treesitter.foldexpr()')
    else
      use(window, 'syntax')
    end
  end
end

--- Switches to the server, which also folds regions and imports.
---@param buffer integer
function M.attached(buffer)
  if not is_enabled() or not vim.lsp.foldexpr then
    return
  end
  for _, window in ipairs(vim.fn.win_findbuf(buffer)) do
    use(window, 'expr', 'v:lua.vim.lsp.foldexpr()')
  end
end

return M
