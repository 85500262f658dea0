--- Indentation without the server: one step for each open brace.

local M = {}

--- How many lines to search for the start of a comment.
local LONGEST_COMMENT = 200

--- A line without its comments.
---@param line string
---@return string
local function code(line)
  return (line:gsub('/%*.-%*/', ''):gsub('//.*', ''):gsub('/%*.*', ''))
end

--- The rest of a line that begins inside a block comment, without its comments.
---@param line string
---@return string
local function after_comment(line)
  local _, last = line:find('*/', 1, true)
  return last and code(line:sub(last + 1)) or ''
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

--- The words that begin a declaration.
local DECLARATIONS = {
  import = true,
  wheel = true,
  wheelH = true,
  sensor = true,
  ip = true,
  robot = true,
  parallel = true,
  movement = true,
  environment = true,
}

--- How many lines to search for the start of a declaration.
local LONGEST_DECLARATION = 2000

--- The line that begins the declaration before a line: only what follows it counts, whatever was forgotten before.
---@param number integer
---@return integer
local function declaration_before(number)
  for before = number - 1, math.max(1, number - LONGEST_DECLARATION), -1 do
    if DECLARATIONS[vim.fn.getline(before):match('^%s*([%a_][%w_]*)') or ''] and not enclosing_comment(before) then
      return before
    end
  end
  return number
end

--- How many braces are open at the start of a line.
---@param number integer
---@return integer
local function depth_before(number)
  local depth = 0
  for before = declaration_before(number), number - 1 do
    local line = vim.fn.getline(before)
    for brace in (enclosing_comment(before) and after_comment(line) or code(line)):gmatch('[{}]') do
      depth = math.max(0, depth + (brace == '{' and 1 or -1))
    end
  end
  return depth
end

--- For 'indentexpr': the indentation of a line, in columns: the canonical one, whatever the lines before look like.
---@param number integer Starts at 1.
---@return integer -1 keeps the indentation.
function M.of_line(number)
  local line = vim.fn.getline(number)
  local comment = enclosing_comment(number)
  if comment then
    return line:match('^%s*%*') and vim.fn.indent(comment) + 1 or -1
  end
  local steps = depth_before(number) - (line:match('^%s*}') and 1 or 0)
  return math.max(0, steps) * vim.fn.shiftwidth()
end

return M
