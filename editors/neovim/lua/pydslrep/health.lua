--- `:checkhealth pydslrep`: what is there, what is not, and what to do next.

local config = require('pydslrep.config')
local parser = require('pydslrep.parser')
local server = require('pydslrep.server')

local M = {}

--- What a program says of itself in one line, or nothing if it cannot be started.
---@param command string[]
---@return string?
local function ask(command)
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
    vim.health.warn(version .. ' works, but knows less of the protocol', 'Neovim 0.11 or later folds by the server')
  end
  for _, problem in ipairs(vim.g.pydslrep and config.problems(vim.g.pydslrep) or {}) do
    vim.health.error('options: ' .. problem, ':help pydslrep-options')
  end
end

--- What goes with a server: the command of the same build.
---@param executable string
---@return string
local function command_beside(executable)
  local beside = vim.fs.joinpath(vim.fs.dirname(vim.uv.fs_realpath(executable) or executable), 'pydslrep')
  return vim.fn.executable(beside) == 1 and beside or 'pydslrep'
end

local function language_server()
  vim.health.start('Language server')
  local set = vim.lsp.config and vim.lsp.config[server.NAME] or {}
  local command = set.cmd or server.command()
  if type(command) ~= 'table' then
    vim.health.info('a function of yours starts it')
    return
  end
  local path = vim.fn.exepath(command[1])
  if path == '' then
    vim.health.error(('there is no `%s`'):format(command[1]), server.ADVICE)
    return
  end
  local version = ask({ path, '--version' })
  if not version then
    vim.health.error(path .. ' does not start', 'run it in a terminal: ' .. path .. ' --version')
    return
  end
  vim.health.ok(('%s: %s'):format(path, version))
  local clients = server.clients()
  if #clients == 0 then
    vim.health.info('not running; it starts with the first program (`*.pyr`)')
  end
  for _, client in ipairs(clients) do
    local buffers = vim.tbl_count(client.attached_buffers)
    local place = client.root_dir or 'no folder: neither a pydslrep.toml nor a .git is above the program'
    vim.health.ok(('running for %d buffer%s, %s'):format(buffers, buffers == 1 and '' or 's', place))
  end
  local beside = command_beside(path)
  local found = ask({ beside, '--version' })
  if found then
    vim.health.ok(('%s, for runs and previews: %s'):format(beside, found))
  else
    vim.health.warn('there is no `pydslrep`: no runs and no previews',
      'in a clone of PyDSLRep: cargo install --locked --path crates/cli')
  end
end

local function python()
  vim.health.start('Python')
  local advice = 'runs need Python 3.11 or later with venv: `pydslrep run --help`'
  for _, name in ipairs({ 'python3', 'python' }) do
    local version = ask({ name, '--version' })
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
  vim.health.warn('there is no `python3`: no runs', advice)
end

local function colours()
  vim.health.start('Tree-sitter parser')
  local ready, why = parser.is_ready()
  if ready then
    vim.health.ok(parser.found())
    return
  end
  vim.health.info('not there: programs get their colours from the syntax file and the server')
  if parser.found() then
    vim.health.warn('there is one that cannot be used: ' .. why, ':Pydslrep parser builds it anew')
  elseif not parser.compiler() then
    vim.health.info('to build it, install a C compiler; then :Pydslrep parser')
  else
    vim.health.info((':Pydslrep parser builds it, with %s'):format(parser.compiler()))
  end
end

function M.check()
  neovim()
  language_server()
  python()
  colours()
end

return M
