--- Scripts, runs and previews: the server's commands about an environment, and what they come to.

local say = require('pydslrep.say')
local server = require('pydslrep.server')

local M = {}

---@class pydslrep.Chosen What the server's commands are about.
---@field uri string
---@field environment string

---@class pydslrep.Run
---@field client vim.lsp.Client
---@field token string What its progress goes by.
---@field progress pydslrep.Progress
---@field stopping boolean

---@class pydslrep.Result
---@field picture? string
---@field output? string

--- The run there is, and how many there were.
---@type pydslrep.Run?
local current
local count = 0

local TITLES = { ['pydslrep.run'] = 'Run', ['pydslrep.previewPath'] = 'Preview' }

--- How many lines of a run are seen at once.
local HEIGHT = 14

--- Shows what was printed, in a window of its own below; the cursor stays.
---@param name string
---@param result pydslrep.Result
local function show(name, result)
  local lines = vim.split((result.output or ''):gsub('^%s*\n', ''):gsub('%s+$', ''), '\n')
  if result.picture then
    vim.list_extend(lines, { '', vim.uri_to_fname(result.picture) })
  end
  local buffer = vim.fn.bufnr('^' .. vim.fn.escape(name, '[]*?') .. '$')
  if buffer < 0 then
    buffer = vim.api.nvim_create_buf(false, true)
    vim.api.nvim_buf_set_name(buffer, name)
    vim.keymap.set('n', 'q', '<Cmd>close<CR>', { buffer = buffer, desc = 'Close' })
  end
  vim.bo[buffer].modifiable = true
  vim.api.nvim_buf_set_lines(buffer, 0, -1, false, lines)
  vim.bo[buffer].modifiable = false
  if vim.fn.bufwinid(buffer) < 0 then
    local before = vim.api.nvim_get_current_win()
    vim.cmd(('botright %dsplit'):format(math.min(HEIGHT, #lines + 1)))
    vim.api.nvim_win_set_buf(0, buffer)
    vim.wo[0][0].wrap, vim.wo[0][0].number, vim.wo[0][0].relativenumber = false, false, false
    vim.wo[0][0].winfixheight = true
    vim.api.nvim_set_current_win(before)
  end
end

---@param run pydslrep.Run
---@param status 'success'|'failed'|'cancel'
---@param message string
local function finish(run, status, message)
  if current == run then
    current = nil
    say.progress(run.progress, status, message)
  end
end

--- Has the server do something with an environment.
---@param client vim.lsp.Client
---@param buffer integer
---@param command string
---@param chosen pydslrep.Chosen
function M.execute(client, buffer, command, chosen)
  local params = { command = command, arguments = { chosen } }
  local title = TITLES[command]
  if not title then
    server.ask(client, 'workspace/executeCommand', params, function(problem)
      if problem then
        say.error(problem.message)
      end
    end, buffer)
    return
  end
  if current then
    say.warning(('%s is not finished yet; `:Pydslrep stop` stops it'):format(current.progress.title))
    return
  end
  count = count + 1
  local name = ('%s of %s'):format(title, chosen.environment)
  ---@type pydslrep.Run
  local run = { client = client, token = 'pydslrep-' .. count, progress = { title = name }, stopping = false }
  params.workDoneToken = run.token
  current = run
  say.progress(run.progress, 'running', 'starts')
  server.ask(client, 'workspace/executeCommand', params, function(problem, result)
    if problem and run.stopping then
      finish(run, 'cancel', 'stopped')
    elseif problem then
      finish(run, 'failed', 'failed')
      say.error(problem.message)
    else
      finish(run, 'success', 'done')
      show(('pydslrep://%s/%s'):format(chosen.environment, title:lower()), result or {})
    end
  end, buffer)
end

--- Does something with an environment of the current buffer: with the one that is named, the only one, the one the
--- cursor is on, or the one that is chosen.
---@param command string
---@param environment? string
function M.start(command, environment)
  local buffer = vim.api.nvim_get_current_buf()
  local client = server.client(buffer)
  if not client then
    return
  end
  if environment then
    M.execute(client, buffer, command, { uri = vim.uri_from_bufnr(buffer), environment = environment })
    return
  end
  local line = vim.api.nvim_win_get_cursor(0)[1] - 1
  local params = { textDocument = { uri = vim.uri_from_bufnr(buffer) } }
  server.ask(client, 'textDocument/codeLens', params, function(problem, lenses)
    if problem then
      say.error(problem.message)
      return
    end
    ---@type pydslrep.Chosen[]
    local found = {}
    for _, lens in ipairs(lenses or {}) do
      if lens.command and lens.command.command == command then
        table.insert(found, lens.command.arguments[1])
        if lens.range.start.line == line then
          found = { lens.command.arguments[1] }
          break
        end
      end
    end
    if #found == 0 then
      say.error('this program has no environment; its scripts are made of environments')
    elseif #found == 1 then
      M.execute(client, buffer, command, found[1])
    else
      local options = { prompt = 'Environment', format_item = function(chosen) return chosen.environment end }
      vim.ui.select(found, options, function(chosen)
        if chosen then
          M.execute(client, buffer, command, chosen)
        end
      end)
    end
  end, buffer)
end

--- Stops the run there is, as Ctrl-C does.
function M.stop()
  if not current then
    say.information('nothing runs')
    return
  end
  current.stopping = true
  server.tell(current.client, 'window/workDoneProgress/cancel', { token = current.token })
end

--- What the server says of how far it is. Neovim passes a request's cancellation on to nobody, so that its end is told
--- by that of its progress.
---@param data { client_id: integer, params: lsp.ProgressParams }
function M.progressed(data)
  local run, params = current, data.params
  if not run or data.client_id ~= run.client.id or params.token ~= run.token then
    return
  end
  local value = params.value
  if value.kind == 'end' then
    if run.stopping then
      finish(run, 'cancel', 'stopped')
    end
  elseif value.message then
    say.progress(run.progress, 'running', value.message)
  end
end

--- The server has ended, and with it what it ran.
---@param client_id integer
function M.left(client_id)
  if current and current.client.id == client_id then
    finish(current, 'failed', 'the server has ended')
  end
end

return M
