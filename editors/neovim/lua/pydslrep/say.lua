--- Words to the person.

local M = {}

---@param level integer
local function speaker(level)
  ---@param message string
  return function(message)
    vim.notify('pydslrep: ' .. message, level)
  end
end

M.information = speaker(vim.log.levels.INFO)
M.warning = speaker(vim.log.levels.WARN)
M.error = speaker(vim.log.levels.ERROR)

---@class pydslrep.Progress
---@field title string
---@field id? integer|string The message that is written anew with each step, where Neovim can do so.

--- Says how far something is, in place of what was said of it before.
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
