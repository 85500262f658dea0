--- `:checkhealth pydslrep`: what is installed, what is missing, and what to do about it.

local config = require('pydslrep.config')
local parser = require('pydslrep.parser')
local server = require('pydslrep.server')

local M = {}

--- The first line that a command prints; nil if it fails.
---@param command string[]
---@return string?
local function first_line(command)
  local started, process = pcall(vim.system, command, { text = true, timeout = 5000 })
  if not started then
    return nil
  end
  local done = process:wait()
  return done.code == 0 and vim.trim(vim.split(done.stdout .. done.stderr, '\n')[1]) or nil
end

local function neovim()
  vim.health.start('Neovim')
  local version = tostring(vim.version())
  if vim.fn.has('nvim-0.11') == 1 then
    vim.health.ok(version)
  else
    vim.health.warn(version .. ' lacks some LSP features', 'Neovim 0.11 or later supports folding by the server')
  end
  for _, problem in ipairs(vim.g.pydslrep and config.problems(vim.g.pydslrep) or {}) do
    vim.health.error('options: ' .. problem, ':help pydslrep-options')
  end
end

--- The command that was built with a server.
---@param executable string
---@return string
local function command_next_to(executable)
  local command = vim.fs.joinpath(vim.fs.dirname(vim.uv.fs_realpath(executable) or executable), 'pydslrep')
  return vim.fn.executable(command) == 1 and command or 'pydslrep'
end

local function language_server()
  vim.health.start('Language server')
  local set = vim.lsp.config and vim.lsp.config[server.NAME] or {}
  local command = set.cmd or server.command()
  if type(command) ~= 'table' then
    vim.health.info('started by a function in your configuration')
    return
  end
  local path = vim.fn.exepath(command[1])
  if path == '' then
    vim.health.error(('`%s` was not found'):format(command[1]), server.ADVICE)
    return
  end
  local version = first_line({ path, '--version' })
  if not version then
    vim.health.error(path .. ' does not start', 'run it in a terminal: ' .. path .. ' --version')
    return
  end
  vim.health.ok(('%s: %s'):format(path, version))
  local clients = server.clients()
  if #clients == 0 then
    vim.health.info('not running; starts with the first program (`*.pyr`)')
  end
  for _, client in ipairs(clients) do
    local buffers = vim.tbl_count(client.attached_buffers)
    local folder = client.root_dir or 'no folder: no parent folder contains pydslrep.toml or .git'
    vim.health.ok(('running for %d buffer%s, %s'):format(buffers, buffers == 1 and '' or 's', folder))
  end
  local companion = command_next_to(path)
  local found = first_line({ companion, '--version' })
  if found then
    vim.health.ok(('%s, for runs and previews: %s'):format(companion, found))
  else
    vim.health.warn('`pydslrep` was not found; runs and previews need it',
      'in a clone of PyDSLRep: cargo install --locked --path crates/cli')
  end
end

local function python()
  vim.health.start('Python')
  local advice = 'runs need Python 3.11 or later with venv; see `pydslrep run --help`'
  for _, name in ipairs({ 'python3', 'python' }) do
    local version = first_line({ name, '--version' })
    if version then
      local major, minor = version:match('(%d+)%.(%d+)')
      local what = ('%s: %s'):format(vim.fn.exepath(name), version)
      if tonumber(major) == 3 and tonumber(minor) >= 10 then
        vim.health.ok(what)
      else
        vim.health.warn(what, advice)
      end
      return
    end
  end
  vim.health.warn('`python3` was not found; runs need it', advice)
end

local function colours()
  vim.health.start('Tree-sitter parser')
  local ready, why = parser.is_ready()
  if ready then
    vim.health.ok(parser.found())
    return
  end
  vim.health.info('not installed; the syntax file and the server highlight programs')
  if parser.found() then
    vim.health.warn('installed, but cannot be used: ' .. why, 'rebuild it with :Pydslrep parser')
  elseif not parser.compiler() then
    vim.health.info('to build it, install a C compiler and run :Pydslrep parser')
  else
    vim.health.info((':Pydslrep parser builds it with %s'):format(parser.compiler()))
  end
end

function M.check()
  neovim()
  language_server()
  python()
  colours()
end

return M
