--- Finds and builds the tree-sitter parser. It is optional: without it, the syntax file highlights programs until the
--- server responds.

local config = require('pydslrep.config')
local notify = require('pydslrep.notify')

local M = {}

M.LANGUAGE = 'pydslrep'

--- Where `:Pydslrep parser` installs it: a folder on the runtime path.
---@return string
function M.path()
  return vim.fs.joinpath(vim.fn.stdpath('data') --[[@as string]], 'site', 'parser', M.LANGUAGE .. '.so')
end

--- The installed parser: the one that was built, or else any on the runtime path (which may lack that folder).
---@return string?
function M.found()
  local path = M.path()
  return vim.uv.fs_stat(path) and path or vim.api.nvim_get_runtime_file('parser/' .. M.LANGUAGE .. '.*', false)[1]
end

--- Whether parser and queries are installed and match; if not, why.
---@return boolean, string?
function M.is_ready()
  local path = M.found()
  if not path then
    return false, 'not installed'
  end
  -- Neovim 0.10 returns nothing, later versions whether it is loaded; the reason is raised or returned.
  local added, loaded, why = pcall(vim.treesitter.language.add, M.LANGUAGE, { path = path })
  if not added or loaded == false or (loaded == nil and why) then
    return false, tostring(why or loaded)
  end
  local fits, query = pcall(vim.treesitter.query.get, M.LANGUAGE, 'highlights')
  if not fits or not query then
    return false, 'its queries do not match its version: ' .. tostring(query)
  end
  return true
end

--- Highlights a buffer with the parser, if it is installed.
---@param buffer integer
---@return boolean Whether it is.
function M.highlight(buffer)
  return config.get().highlight and M.is_ready() and (pcall(vim.treesitter.start, buffer, M.LANGUAGE))
end

--- The grammar's folder: the option, or else the one in the same clone of PyDSLRep as this plugin.
---@return string
function M.grammar()
  local file = debug.getinfo(1, 'S').source:sub(2)
  local plugin = vim.fs.dirname(vim.fs.dirname(vim.fs.dirname(vim.uv.fs_realpath(file) or file)))
  return config.get().grammar or vim.fs.joinpath(vim.fs.dirname(vim.fs.dirname(plugin)), 'grammar', 'tree-sitter')
end

--- The C compiler: `$CC`, or else the first one found.
---@return string?
function M.compiler()
  for _, name in ipairs({ vim.env.CC or '', 'cc', 'gcc', 'clang' }) do
    if name ~= '' and vim.fn.executable(name) == 1 then
      return name
    end
  end
end

--- The command that builds the parser.
---@param compiler string
---@param grammar string
---@param output string
---@return string[]
function M.build_command(compiler, grammar, output)
  local source = vim.fs.joinpath(grammar, 'src')
  return { compiler, '-shared', '-fPIC', '-Os', '-I', source, '-o', output, vim.fs.joinpath(source, 'parser.c') }
end

--- Highlights all open programs.
local function highlight_all()
  for _, buffer in ipairs(vim.api.nvim_list_bufs()) do
    if vim.api.nvim_buf_is_loaded(buffer) and vim.bo[buffer].filetype == M.LANGUAGE then
      M.highlight(buffer)
    end
  end
end

--- Builds the parser and installs it where Neovim finds it.
---@param grammar? string
---@return boolean Whether it succeeded.
function M.install(grammar)
  grammar = vim.fs.normalize(grammar or M.grammar())
  if not vim.uv.fs_stat(vim.fs.joinpath(grammar, 'src', 'parser.c')) then
    local advice = 'use `:Pydslrep parser FOLDER` with the folder grammar/tree-sitter of a clone of PyDSLRep'
    notify.error(('no grammar in %s; %s'):format(grammar, advice))
    return false
  end
  local compiler = M.compiler()
  if not compiler then
    notify.error('no C compiler was found: install one, or set $CC')
    return false
  end
  local had_one = M.is_ready()
  local path = M.path()
  vim.fn.mkdir(vim.fs.dirname(path), 'p')
  -- The installed file may be in use.
  local new = path .. '.new'
  local done = vim.system(M.build_command(compiler, grammar, new), { text = true }):wait()
  if done.code ~= 0 then
    notify.error(('%s failed to build the parser:\n%s'):format(compiler, done.stderr))
    return false
  end
  local moved, why = vim.uv.fs_rename(new, path)
  if not moved then
    notify.error(('cannot install the parser: %s'):format(why))
    return false
  end
  highlight_all()
  notify.info(('built %s%s'):format(path, had_one and '; restart Neovim to use it' or ''))
  return true
end

return M
