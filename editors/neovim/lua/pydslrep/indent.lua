--- Indentation without the server: one step for each open brace.

local M = {}

--- How many lines to search for the start of a comment.
local LONGEST_COMMENT = 200

--- A line without its comments.
---@param line string
---@return string
local function code(line)
  return (line:gsub('/%*.-%*/', ''):gsub('//.*', ''):gsub('/%*.*', ''):gsub('^.*%*/', ''))
end

--- The first line of the block comment that a line starts in, if any.
---@param number integer
---@return integer?
local function enclosing_comment(number)
  for before = number - 1, math.max(1, number - LONGEST_COMMENT), -1 do
    local line = vim.fn.getline(before):gsub('/%*.-%*/', ''):gsub('//.*', '')
    if line:find('/*', 1, true) then
      return before
    elseif line:find('*/', 1, true) then
      return nil
    end
  end
end

--- How many more braces a line opens than it closes, and how many of them it closes first.
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

--- For 'indentexpr': the indentation of a line, in columns.
---@param number integer Starts at 1.
---@return integer -1 keeps the indentation.
function M.of_line(number)
  local line = vim.fn.getline(number)
  local comment = enclosing_comment(number)
  if comment then
    return line:match('^%s*%*') and vim.fn.indent(comment) + 1 or -1
  end
  local before = vim.fn.prevnonblank(number - 1)
  if before == 0 then
    return 0
  end
  local depth, closed_first = braces(vim.fn.getline(before))
  -- A brace closed at the start of a line has already moved that line.
  local starts_closing = code(vim.fn.getline(before)):match('^%s*}') and 1 or 0
  local steps = depth + math.min(closed_first, starts_closing)
  if line:match('^%s*}') then
    steps = steps - 1
  end
  return math.max(0, vim.fn.indent(enclosing_comment(before) or before) + steps * vim.fn.shiftwidth())
end

return M
