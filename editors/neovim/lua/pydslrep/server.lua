--- The language server: where it is, for which files it is started, and how it is started again.

local config = require('pydslrep.config')
local say = require('pydslrep.say')

local M = {}

M.NAME = 'pydslrep'

--- How to get the server where it is not found.
M.ADVICE = 'in a clone of PyDSLRep, `cargo install --locked --path crates/server` installs it; '
  .. "or name it: vim.g.pydslrep = { cmd = { '/path/to/pydslrep-lsp', '--stdio' } }"

--- The command that starts the server: what is set, else `pydslrep-lsp` or `pydslrep lsp` from the path or from where
--- Cargo installs. Where there is none, the first, so that messages name it.
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

--- Of all the TOML there is, only its own settings and scenes are the server's business.
---@param buffer integer
---@return boolean
function M.is_ours(buffer)
  if vim.bo[buffer].filetype == 'pydslrep' then
    return true
  end
  local name = vim.fs.basename(vim.api.nvim_buf_get_name(buffer))
  return name == 'pydslrep.toml' or vim.endswith(name, '.scene.toml')
end

--- The command as it is in force: `vim.lsp.config('pydslrep', { cmd = … })` wins.
---@return string[]?
local function command_in_force()
  local set = vim.lsp.config and vim.lsp.config[M.NAME] or {}
  local command = set.cmd or M.command()
  return type(command) == 'table' and command or nil
end

local told = false

--- Says, once, if the server is to be started and is not there. Neovim itself says so in its log only (0.12), or with
--- every program that is opened.
function M.look_for_it()
  local command = config.get().enable and command_in_force()
  if told or not command or vim.fn.executable(command[1]) == 1 then
    return
  end
  told = true
  say.warning(('there is no `%s`: %s. :checkhealth pydslrep says more'):format(command[1], M.ADVICE))
end

--- Whether the server can be started for a buffer.
---@param buffer integer
---@return boolean
local function can_start(buffer)
  local command = command_in_force()
  return M.is_ours(buffer) and (not command or vim.fn.executable(command[1]) == 1)
end

---@param buffer integer
---@return string?
local function root(buffer)
  return vim.fs.root(buffer, { 'pydslrep.toml', '.git' })
end

--- What `vim.lsp.config` is to know of the server.
---@return vim.lsp.Config
function M.config()
  local settings = config.get().settings
  -- An empty table would reach the server as a list.
  settings = next(settings) and settings or nil
  return {
    cmd = M.command(),
    filetypes = { 'pydslrep', 'toml' },
    root_dir = function(buffer, use)
      if can_start(buffer) then
        use(root(buffer))
      end
    end,
    init_options = settings,
    settings = settings and { pydslrep = settings },
    capabilities = { experimental = { commands = { commands = { 'pydslrep.showReferences' } } } },
    handlers = { ['window/showDocument'] = require('pydslrep.pictures').show_document },
    on_exit = function(_, _, client_id)
      vim.schedule(function()
        require('pydslrep.runs').left(client_id)
      end)
    end,
  }
end

--- Starts the server for a buffer where Neovim (0.10) cannot do so on its own.
---@param buffer integer
local function start(buffer)
  if not can_start(buffer) then
    return
  end
  local chosen = M.config()
  vim.lsp.start({
    name = M.NAME,
    cmd = chosen.cmd,
    root_dir = root(buffer),
    init_options = chosen.init_options,
    settings = chosen.settings,
    capabilities = vim.tbl_deep_extend('force', vim.lsp.protocol.make_client_capabilities(), chosen.capabilities),
    handlers = chosen.handlers,
    on_exit = chosen.on_exit,
  }, { bufnr = buffer })
end

--- Has the server started for programs, settings and scenes, those that are open included.
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

--- The same, unless that is switched off.
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

--- The server of a buffer; where there is none, it says so.
---@param buffer integer
---@return vim.lsp.Client?
function M.client(buffer)
  local client = M.clients({ bufnr = buffer })[1]
  if not client then
    say.error('the server is not attached to this buffer; :checkhealth pydslrep says why')
  end
  return client
end

--- Asks the server, in a way that all versions of Neovim know.
---@param client vim.lsp.Client
---@param method string
---@param params table
---@param answer fun(problem: lsp.ResponseError?, result: any)
---@param buffer integer
function M.ask(client, method, params, answer, buffer)
  if vim.fn.has('nvim-0.11') == 1 then
    client:request(method, params, answer, buffer)
  else
    client.request(method, params, answer, buffer)
  end
end

---@param client vim.lsp.Client
---@param method string
---@param params table
function M.tell(client, method, params)
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

--- How often, and how many times, it is looked whether the server has ended, before it is killed.
local LOOK_EVERY_MS, LOOKS = 20, 100

---@param looks integer
local function start_when_ended(looks)
  local clients = M.clients()
  if #clients > 0 then
    if looks == 0 then
      for _, client in ipairs(clients) do
        stop(client, true)
      end
    end
    vim.defer_fn(function()
      start_when_ended(looks - 1)
    end, LOOK_EVERY_MS)
    return
  end
  enable()
  say.information('the server starts again')
end

--- Ends the server and starts it again, for all its buffers.
function M.restart()
  told = false
  if vim.lsp.enable then
    vim.lsp.enable(M.NAME, false)
  end
  for _, client in ipairs(M.clients()) do
    stop(client, false)
  end
  start_when_ended(LOOKS)
end

--- Opens Neovim's log of all language servers, at its end.
function M.log()
  local path = vim.lsp.log and vim.lsp.log.get_filename and vim.lsp.log.get_filename() or vim.lsp.get_log_path()
  vim.cmd.tabedit({ args = { vim.fn.fnameescape(path) } })
  vim.bo.autoread, vim.bo.modifiable = true, false
  vim.cmd('normal! G')
end

return M
