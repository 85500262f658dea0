--- Executes the server's commands on an environment and shows their results.

local notify = require('pydslrep.notify')
local server = require('pydslrep.server')

local M = {}

---@class pydslrep.EnvironmentId The argument of the server's commands.
---@field uri string
---@field environment string

---@class pydslrep.Run
---@field client vim.lsp.Client
---@field token string Identifies its progress.
---@field progress pydslrep.Progress
---@field stopping boolean

---@class pydslrep.Result
---@field picture? string
---@field output? string

--- The current run, and the number of runs so far.
---@type pydslrep.Run?
local current
local count = 0

local TITLES = { ['pydslrep.run'] = 'Run', ['pydslrep.previewPath'] = 'Preview' }

--- The most lines that the window of a run has.
local HEIGHT = 14

--- Shows the output in a window below; the cursor stays.
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

--- The marks of actions that failed in the latest run.
local failures = vim.api.nvim_create_namespace('pydslrep-run')

--- Marks the action that made a run fail, until the next run.
---@param client vim.lsp.Client
---@param problem lsp.ResponseError
local function mark(client, problem)
  local data = type(problem.data) == 'table' and problem.data or {}
  if data.reason ~= 'failed-run' or type(data.location) ~= 'table' then
    return
  end
  local buffer = vim.uri_to_bufnr(data.location.uri)
  vim.fn.bufload(buffer)
  local place = vim.lsp.util.locations_to_items({ data.location }, client.offset_encoding)[1]
  vim.diagnostic.set(failures, buffer, { {
    lnum = place.lnum - 1,
    col = place.col - 1,
    end_lnum = place.end_lnum and place.end_lnum - 1,
    end_col = place.end_col and place.end_col - 1,
    severity = vim.diagnostic.severity.ERROR,
    source = 'pydslrep run',
    message = problem.message,
  } })
end

---@param run pydslrep.Run
---@param status 'success'|'failed'|'cancel'
---@param message string
local function finish(run, status, message)
  if current == run then
    current = nil
    notify.progress(run.progress, status, message)
  end
end

--- Executes a command on an environment.
---@param client vim.lsp.Client
---@param buffer integer
---@param command string
---@param id pydslrep.EnvironmentId
function M.execute(client, buffer, command, id)
  local params = { command = command, arguments = { id } }
  local title = TITLES[command]
  if not title then
    server.request(client, 'workspace/executeCommand', params, function(problem)
      if problem then
        notify.error(problem.message)
      end
    end, buffer)
    return
  end
  if current then
    notify.warning(('%s is still running; stop it with `:Pydslrep stop`'):format(current.progress.title))
    return
  end
  count = count + 1
  local name = ('%s of %s'):format(title, id.environment)
  ---@type pydslrep.Run
  local run = { client = client, token = 'pydslrep-' .. count, progress = { title = name }, stopping = false }
  params.workDoneToken = run.token
  current = run
  vim.diagnostic.reset(failures)
  notify.progress(run.progress, 'running', 'starting')
  server.request(client, 'workspace/executeCommand', params, function(problem, result)
    if problem and run.stopping then
      finish(run, 'cancel', 'stopped')
    elseif problem then
      finish(run, 'failed', 'failed')
      mark(client, problem)
      notify.error(problem.message)
    else
      finish(run, 'success', 'done')
      show(('pydslrep://%s/%s'):format(id.environment, title:lower()), result or {})
    end
  end, buffer)
end

--- Executes a command on an environment of the current buffer: the given one, the only one, the one that starts on the
--- line of the cursor, or one chosen from a list.
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
  server.request(client, 'textDocument/codeLens', params, function(problem, lenses)
    if problem then
      notify.error(problem.message)
      return
    end
    ---@type pydslrep.EnvironmentId[]
    local found = {}
    for _, lens in ipairs(lenses or {}) do
      local id = (lens.command and lens.command.arguments or {})[1]
      if type(id) == 'table' and id.environment and not vim.deep_equal(id, found[#found]) then
        table.insert(found, id)
        if lens.range.start.line == line then
          found = { id }
          break
        end
      end
    end
    if #found == 0 then
      notify.error('this program has no environment; add one to run it or to generate its script')
    elseif #found == 1 then
      M.execute(client, buffer, command, found[1])
    else
      local options = { prompt = 'Environment', format_item = function(id) return id.environment end }
      vim.ui.select(found, options, function(id)
        if id then
          M.execute(client, buffer, command, id)
        end
      end)
    end
  end, buffer)
end

--- Stops the run there is, as Ctrl-C does.
function M.stop()
  if not current then
    notify.info('nothing is running')
    return
  end
  current.stopping = true
  server.notify(current.client, 'window/workDoneProgress/cancel', { token = current.token })
end

--- Handles progress of the run. Neovim does not report cancelled requests, so the end of the progress ends the run.
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
    notify.progress(run.progress, 'running', value.message)
  end
end

--- Ends the run of a server that has exited.
---@param client_id integer
function M.client_exited(client_id)
  if current and current.client.id == client_id then
    finish(current, 'failed', 'the server exited')
  end
end

return M
