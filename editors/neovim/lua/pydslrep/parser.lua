--- The tree-sitter parser: whether it is there, and how it is built. Everything works without it; programs then get
--- their colours from the syntax file until the server is there.

local config = require('pydslrep.config')
local say = require('pydslrep.say')

local M = {}

M.LANGUAGE = 'pydslrep'

--- Where `:Pydslrep parser` puts it: a folder of the runtime path.
---@return string
function M.path()
  return vim.fs.joinpath(vim.fn.stdpath('data') --[[@as string]], 'site', 'parser', M.LANGUAGE .. '.so')
end

--- The parser there is: the one that was built, else any in the runtime path, which may not have that folder yet.
---@return string?
function M.found()
  local path = M.path()
  return vim.uv.fs_stat(path) and path or vim.api.nvim_get_runtime_file('parser/' .. M.LANGUAGE .. '.*', false)[1]
end

--- Whether parser and queries are there and fit each other; if not, why.
---@return boolean, string?
function M.is_ready()
  local path = M.found()
  if not path then
    return false, 'there is none'
  end
  -- Neovim 0.10 answers with nothing, later ones with whether it is loaded; why it is not is an error or an answer.
  local added, loaded, why = pcall(vim.treesitter.language.add, M.LANGUAGE, { path = path })
  if not added or loaded == false or (loaded == nil and why) then
    return false, tostring(why or loaded)
  end
  local fits, query = pcall(vim.treesitter.query.get, M.LANGUAGE, 'highlights')
  if not fits or not query then
    return false, 'its queries are for another version: ' .. tostring(query)
  end
  return true
end

--- Colours a buffer by it, if it is there.
---@param buffer integer
---@return boolean whether it is
function M.highlight(buffer)
  return config.get().highlight and M.is_ready() and (pcall(vim.treesitter.start, buffer, M.LANGUAGE))
end

--- The grammar's folder: what is set, else the one beside this plugin in a clone of PyDSLRep.
---@return string
function M.grammar()
  local own = debug.getinfo(1, 'S').source:sub(2)
  local plugin = vim.fs.dirname(vim.fs.dirname(vim.fs.dirname(vim.uv.fs_realpath(own) or own)))
  return config.get().grammar or vim.fs.joinpath(vim.fs.dirname(vim.fs.dirname(plugin)), 'grammar', 'tree-sitter')
end

--- The C compiler: `$CC`, else the first there is.
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

--- Colours all programs that are open.
local function highlight_all()
  for _, buffer in ipairs(vim.api.nvim_list_bufs()) do
    if vim.api.nvim_buf_is_loaded(buffer) and vim.bo[buffer].filetype == M.LANGUAGE then
      M.highlight(buffer)
    end
  end
end

--- Builds the parser of a grammar and puts it where Neovim finds it.
---@param grammar? string
---@return boolean whether that worked
function M.install(grammar)
  grammar = vim.fs.normalize(grammar or M.grammar())
  if not vim.uv.fs_stat(vim.fs.joinpath(grammar, 'src', 'parser.c')) then
    local advice = '`:Pydslrep parser FOLDER` names the folder grammar/tree-sitter of a clone of PyDSLRep'
    say.error(('there is no grammar in %s: %s'):format(grammar, advice))
    return false
  end
  local compiler = M.compiler()
  if not compiler then
    say.error('the parser has to be compiled: install a C compiler, or name one in $CC')
    return false
  end
  local had_one = M.is_ready()
  local path = M.path()
  vim.fn.mkdir(vim.fs.dirname(path), 'p')
  -- Not over the file that may be in use.
  local new = path .. '.new'
  local done = vim.system(M.build_command(compiler, grammar, new), { text = true }):wait()
  if done.code ~= 0 then
    say.error(('%s did not build the parser:\n%s'):format(compiler, done.stderr))
    return false
  end
  local moved, why = vim.uv.fs_rename(new, path)
  if not moved then
    say.error(('the parser cannot be put into its place: %s'):format(why))
    return false
  end
  highlight_all()
  say.information(('%s is built%s'):format(path, had_one and '; Neovim uses it from its next start on' or ''))
  return true
end

return M
