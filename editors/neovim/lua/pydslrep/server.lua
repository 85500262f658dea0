--- Finds, starts and restarts the language server.

local config = require('pydslrep.config')
local notify = require('pydslrep.notify')

local M = {}

M.NAME = 'pydslrep'

--- How to install the server.
M.ADVICE = 'install it with `cargo install --locked --path crates/server` in a clone of PyDSLRep, '
  .. "or set its path: vim.g.pydslrep = { cmd = { '/path/to/pydslrep-lsp', '--stdio' } }"

--- The command that starts the server: the option, or else `pydslrep-lsp` or `pydslrep lsp` on the PATH or in Cargo's
--- folder. If there is none, the first one, so that messages name it.
---@return string[]
function M.command()
  local set = config.get().cmd
  if set then
    return set
  end
  for _, folder in ipairs({ '', vim.fs.normalize('~/.cargo/bin/') }) do
    for _, command in ipairs({ { 'pydslrep-lsp', '--stdio' }, { 'pydslrep', 'lsp' } }) do
      command[1] = folder .. command[1]
      if vim.fn.executable(command[1]) == 1 then
        return command
      end
    end
  end
  return { 'pydslrep-lsp', '--stdio' }
end

--- Whether a buffer is a program, a settings file or a scene; other TOML is ignored.
---@param buffer integer
---@return boolean
function M.is_supported(buffer)
  if vim.bo[buffer].filetype == 'pydslrep' then
    return true
  end
  local name = vim.fs.basename(vim.api.nvim_buf_get_name(buffer))
  return name == 'pydslrep.toml' or vim.endswith(name, '.scene.toml')
end

--- The command in use; `vim.lsp.config('pydslrep', { cmd = … })` takes precedence. Nil if a function starts it.
---@return string[]?
local function effective_command()
  local set = vim.lsp.config and vim.lsp.config[M.NAME] or {}
  local command = set.cmd or M.command()
  return type(command) == 'table' and command or nil
end

local warned = false

--- Warns once if the server is enabled but not installed. Neovim itself only logs it (0.12), or warns for each program.
function M.warn_if_missing()
  local command = config.get().enable and effective_command()
  if warned or not command or vim.fn.executable(command[1]) == 1 then
    return
  end
  warned = true
  notify.warning(('`%s` was not found: %s. See :checkhealth pydslrep'):format(command[1], M.ADVICE))
end

--- Whether the server can be started for a buffer.
---@param buffer integer
---@return boolean
local function can_start(buffer)
  local command = effective_command()
  return M.is_supported(buffer) and (not command or vim.fn.executable(command[1]) == 1)
end

---@param buffer integer
---@return string?
local function root(buffer)
  return vim.fs.root(buffer, { 'pydslrep.toml', '.git' })
end

---@param client vim.lsp.Client
---@return boolean
local function is_stopped(client)
  if vim.fn.has('nvim-0.11') == 1 then
    return client:is_stopped()
  end
  return client.is_stopped()
end

--- Whether a buffer uses a running client. A client without a folder keeps the folder of its buffers when that becomes
--- a project: a second server would not know the unsaved texts of these buffers, nor the first one unsaved settings.
---@param client vim.lsp.Client
---@param settings vim.lsp.ClientConfig Of the buffer.
---@return boolean
local function serves(client, settings)
  if client.name ~= M.NAME or is_stopped(client) then
    return false
  end
  local folder = settings.root_dir
  if not folder or client.root_dir then
    local function is_same(other)
      return other.name == folder
    end
    return folder == client.root_dir or vim.iter(client.workspace_folders or {}):any(is_same)
  end
  return vim.iter(pairs(client.attached_buffers)):any(function(buffer)
    return vim.startswith(vim.fs.normalize(vim.api.nvim_buf_get_name(buffer)), folder .. '/')
  end)
end

--- The configuration for `vim.lsp.config`.
---@return vim.lsp.Config
function M.config()
  local settings = config.get().settings
  -- Neovim would send an empty table as a list.
  settings = next(settings) and settings or nil
  return {
    cmd = M.command(),
    filetypes = { 'pydslrep', 'toml' },
    root_dir = function(buffer, use)
      if can_start(buffer) then
        use(root(buffer))
      end
    end,
    reuse_client = serves,
    init_options = settings,
    settings = settings and { pydslrep = settings },
    capabilities = { experimental = { commands = { commands = { 'pydslrep.showReferences' } } } },
    handlers = { ['window/showDocument'] = require('pydslrep.pictures').show_document },
    on_exit = function(_, _, client_id)
      vim.schedule(function()
        require('pydslrep.runs').client_exited(client_id)
      end)
    end,
  }
end

--- Starts the server for a buffer in Neovim 0.10, which cannot do so by itself.
---@param buffer integer
local function start(buffer)
  if not can_start(buffer) then
    return
  end
  local settings = M.config()
  vim.lsp.start({
    name = M.NAME,
    cmd = settings.cmd,
    root_dir = root(buffer),
    init_options = settings.init_options,
    settings = settings.settings,
    capabilities = vim.tbl_deep_extend('force', vim.lsp.protocol.make_client_capabilities(), settings.capabilities),
    handlers = settings.handlers,
    on_exit = settings.on_exit,
  }, { bufnr = buffer, reuse_client = settings.reuse_client })
end

--- Starts the server for all open and future programs, settings and scenes.
local function enable()
  if vim.lsp.enable then
    vim.lsp.enable(M.NAME)
    return
  end
  vim.api.nvim_create_autocmd('FileType', {
    group = vim.api.nvim_create_augroup('pydslrep_server', {}),
    pattern = { 'pydslrep', 'toml' },
    callback = function(event)
      start(event.buf)
    end,
  })
  for _, buffer in ipairs(vim.api.nvim_list_bufs()) do
    if vim.api.nvim_buf_is_loaded(buffer) then
      start(buffer)
    end
  end
end

--- Enables the server unless the option `enable` is false.
function M.enable()
  if config.get().enable then
    enable()
  end
end

---@param filter? vim.lsp.get_clients.Filter
---@return vim.lsp.Client[]
function M.clients(filter)
  return vim.lsp.get_clients(vim.tbl_extend('force', filter or {}, { name = M.NAME }))
end

--- The client of a buffer; shows an error if there is none.
---@param buffer integer
---@return vim.lsp.Client?
function M.client(buffer)
  local client = M.clients({ bufnr = buffer })[1]
  if not client then
    notify.error('the server is not attached to this buffer; see :checkhealth pydslrep')
  end
  return client
end

--- Sends a request, in all versions of Neovim.
---@param client vim.lsp.Client
---@param method string
---@param params table
---@param answer fun(problem: lsp.ResponseError?, result: any)
---@param buffer integer
function M.request(client, method, params, answer, buffer)
  if vim.fn.has('nvim-0.11') == 1 then
    client:request(method, params, answer, buffer)
  else
    client.request(method, params, answer, buffer)
  end
end

--- Sends a notification, in all versions of Neovim.
---@param client vim.lsp.Client
---@param method string
---@param params table
function M.notify(client, method, params)
  if vim.fn.has('nvim-0.11') == 1 then
    client:notify(method, params)
  else
    client.notify(method, params)
  end
end

---@param client vim.lsp.Client
---@param force boolean
local function stop(client, force)
  if vim.fn.has('nvim-0.11') == 1 then
    client:stop(force)
  else
    client.stop(force)
  end
end

--- How often and how many times to check whether the server has exited before killing it.
local CHECK_EVERY_MS, CHECKS = 20, 100

---@param checks integer
local function start_after_exit(checks)
  local clients = M.clients()
  if #clients > 0 then
    if checks == 0 then
      for _, client in ipairs(clients) do
        stop(client, true)
      end
    end
    vim.defer_fn(function()
      start_after_exit(checks - 1)
    end, CHECK_EVERY_MS)
    return
  end
  enable()
  notify.info('the server was restarted')
end

--- Restarts the server for all its buffers.
function M.restart()
  warned = false
  if vim.lsp.enable then
    vim.lsp.enable(M.NAME, false)
  end
  for _, client in ipairs(M.clients()) do
    stop(client, false)
  end
  start_after_exit(CHECKS)
end

--- Opens the end of Neovim's log of language servers.
function M.log()
  local path = vim.lsp.log and vim.lsp.log.get_filename and vim.lsp.log.get_filename() or vim.lsp.get_log_path()
  vim.cmd.tabedit({ args = { vim.fn.fnameescape(path) } })
  vim.bo.autoread, vim.bo.modifiable = true, false
  vim.cmd('normal! G')
end

return M
