--- Folding: by the server where it is attached, else by tree-sitter, else by the syntax file.

local config = require('pydslrep.config')

local M = {}

--- Whether the person leaves folding to us: nothing else is set.
---@return boolean
local function is_free()
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
  -- Without a wish of the person's, a program opens with nothing folded.
  if vim.go.foldlevelstart < 0 and vim.go.foldlevel == 0 and options.foldlevel == 0 then
    options.foldlevel = 99
  end
end

--- For a program that is shown and has no server yet.
---@param buffer integer
---@param has_parser boolean
function M.open(buffer, has_parser)
  if not is_free() then
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

--- The server is there: it knows regions and imports, too.
---@param buffer integer
function M.attached(buffer)
  if not is_free() or not vim.lsp.foldexpr then
    return
  end
  for _, window in ipairs(vim.fn.win_findbuf(buffer)) do
    use(window, 'expr', 'v:lua.vim.lsp.foldexpr()')
  end
end

return M
