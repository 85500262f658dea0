--- The colours of what the server knows are those of the parser and of the syntax file, whatever a colour scheme has
--- for servers: nothing changes when the server comes. The pairs are from `grammar/colours.json`.

local M = {}

--- What the server calls a word, and what the parser does.
local CAPTURES = {
  keyword = 'keyword',
  number = 'number',
  string = 'string',
  comment = 'comment',
  variable = 'variable',
  property = 'property',
  enumMember = 'constant',
  class = 'type',
  ['function'] = 'function',
  namespace = 'module',
}

--- Links the groups of the server's words to the parser's; a colour scheme that names them for programs wins.
function M.link()
  for kind, capture in pairs(CAPTURES) do
    local own = ('@lsp.type.%s.pydslrep'):format(kind)
    vim.api.nvim_set_hl(0, own, { link = ('@%s.pydslrep'):format(capture), default = true })
  end
end

return M
