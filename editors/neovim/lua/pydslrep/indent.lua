--- Indentation, also while there is no server: what stands between braces is one step further in.

local M = {}

--- How far back the beginning of a comment is looked for.
local LONGEST_COMMENT = 200

--- A line without its comments.
---@param line string
---@return string
local function code(line)
  return (line:gsub('/%*.-%*/', ''):gsub('//.*', ''):gsub('/%*.*', ''):gsub('^.*%*/', ''))
end

--- The line in which the block comment begins that a line begins in, if it begins in one.
---@param number integer
---@return integer?
local function comment_around(number)
  for before = number - 1, math.max(1, number - LONGEST_COMMENT), -1 do
    local line = vim.fn.getline(before):gsub('/%*.-%*/', ''):gsub('//.*', '')
    if line:find('/*', 1, true) then
      return before
    elseif line:find('*/', 1, true) then
      return nil
    end
  end
end

--- How many more braces a line opens than it closes, and how many it closes before it opens any.
---@param line string
---@return integer, integer
local function braces(line)
  local depth, lowest = 0, 0
  for brace in code(line):gmatch('[{}]') do
    depth = depth + (brace == '{' and 1 or -1)
    lowest = math.min(lowest, depth)
  end
  return depth, -lowest
end

--- For 'indentexpr': the columns that a line is to be indented by.
---@param number integer The line's, from 1.
---@return integer -1 to leave it as it is.
function M.of_line(number)
  local line = vim.fn.getline(number)
  local comment = comment_around(number)
  if comment then
    return line:match('^%s*%*') and vim.fn.indent(comment) + 1 or -1
  end
  local before = vim.fn.prevnonblank(number - 1)
  if before == 0 then
    return 0
  end
  local depth, closed_first = braces(vim.fn.getline(before))
  -- What a line closes at its beginning has moved the line itself already.
  local starts_closing = code(vim.fn.getline(before)):match('^%s*}') and 1 or 0
  local steps = depth + math.min(closed_first, starts_closing)
  if line:match('^%s*}') then
    steps = steps - 1
  end
  return math.max(0, vim.fn.indent(comment_around(before) or before) + steps * vim.fn.shiftwidth())
end

return M
