-- Shared by all sessions: waiting, checks and editing steps.

local M = {}

-- Sessions run in a coroutine, so that Neovim's event loop processes typed keys between the steps.
local routine
local failed = false

function M.sleep(milliseconds)
  vim.defer_fn(function() assert(coroutine.resume(routine)) end, milliseconds)
  coroutine.yield()
end

--- Waits until `condition` returns something, and returns it. The limit is for machines that do other work. Reaching it
--- fails the session, even if the test does not look at the result: otherwise, a wait in vain would only be slow.
function M.wait(condition)
  local deadline = vim.uv.hrtime() + 60e9
  while vim.uv.hrtime() < deadline do
    local value = condition()
    if value then return value end
    M.sleep(10)
  end
  M.check(('the wait in line %d ends'):format(debug.getinfo(2, 'l').currentline), false)
end

function M.check(what, holds, seen)
  failed = failed or not holds
  local detail = not holds and seen ~= nil and ': ' .. vim.inspect(seen) or ''
  io.stdout:write(holds and 'ok   ' or 'FAIL ', what, detail, '\n')
end

--- Checks that `actual()` becomes what is expected.
function M.becomes(what, expected, actual)
  M.wait(function() return vim.deep_equal(actual(), expected) end)
  local seen = actual()
  M.check(what, vim.deep_equal(seen, expected), seen)
end

function M.read(name)
  local file = io.open(name, 'rb')
  if not file then return nil end
  local bytes = file:read('*a')
  file:close()
  return bytes
end

function M.write(name, bytes)
  local file = assert(io.open(name, 'wb'))
  file:write(bytes)
  file:close()
end

function M.client()
  return vim.lsp.get_clients({ bufnr = 0 })[1]
end

--- The id of the server's process, Neovim's only child.
function M.process()
  return vim.api.nvim_get_proc_children(vim.fn.getpid())[1]
end

function M.open(name)
  vim.cmd.edit({ args = { name }, bang = true })
  M.wait(function() return M.client() and M.client().initialized end)
end

function M.text(buffer)
  return table.concat(vim.api.nvim_buf_get_lines(buffer or 0, 0, -1, false), '\n') .. '\n'
end

--- Puts the cursor on the first match of `pattern` in the buffer.
function M.go_to(pattern)
  vim.api.nvim_win_set_cursor(0, { 1, 0 })
  assert(vim.fn.search(pattern, 'c') > 0, pattern)
end

--- The ranges and codes of the errors in a program, by default the current one.
function M.errors(buffer)
  return vim.tbl_map(function(found)
    return { found.lnum, found.col, found.end_lnum, found.end_col, found.code }
  end, vim.diagnostic.get(buffer or 0, { severity = vim.diagnostic.severity.ERROR }))
end

--- Requests code actions by key, applies the one whose title contains `wanted`, and returns all titles.
function M.act(wanted)
  local titles
  local select = vim.ui.select
  vim.ui.select = function(items, options, choose)
    titles = vim.tbl_map(options.format_item, items)
    for index, title in ipairs(titles) do
      if title:find(wanted, 1, true) then return choose(items[index], index) end
    end
    choose(nil, nil)
  end
  vim.api.nvim_input('gra')
  M.wait(function() return titles end)
  vim.ui.select = select
  return titles
end

--- The first notification that contains `wanted` after `act` is called, and all notifications.
function M.notified(wanted, act)
  local all = {}
  local notify = vim.notify
  vim.notify = function(message) table.insert(all, message) end
  act()
  local function find()
    return vim.iter(all):find(function(message) return message:find(wanted, 1, true) ~= nil end)
  end
  local found = M.wait(find)
  vim.notify = notify
  return found, all
end

--- Runs the parts in order and quits Neovim; its exit code says whether all checks passed.
function M.run(parts)
  routine = coroutine.create(function()
    for _, part in ipairs(parts) do
      local ok, why = xpcall(part, debug.traceback)
      if not ok then
        M.check(why, false)
        break -- Each part continues where the one before it ended.
      end
    end
    vim.cmd(failed and 'cquit!' or 'quitall!')
  end)
  vim.schedule(function() assert(coroutine.resume(routine)) end)
end

return M
