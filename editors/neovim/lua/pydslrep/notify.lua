--- Notifications and progress messages.

local M = {}

---@param level integer
local function notifier(level)
  ---@param message string
  return function(message)
    vim.notify('pydslrep: ' .. message, level)
  end
end

M.info = notifier(vim.log.levels.INFO)
M.warning = notifier(vim.log.levels.WARN)
M.error = notifier(vim.log.levels.ERROR)

---@class pydslrep.Progress
---@field title string
---@field id? integer|string The message to replace, if Neovim supports it.

--- Shows the status of an operation, replacing its last message.
---@param progress pydslrep.Progress
---@param status 'running'|'success'|'failed'|'cancel'
---@param message string
function M.progress(progress, status, message)
  if vim.fn.has('nvim-0.12') == 1 then
    local options = {
      id = progress.id,
      kind = 'progress',
      source = 'pydslrep',
      status = status,
      title = progress.title,
    }
    progress.id = vim.api.nvim_echo({ { message } }, status ~= 'running', options)
  else
    vim.api.nvim_echo({ { progress.title .. ': ' .. message } }, status ~= 'running', {})
  end
end

return M
