--- Semantic tokens get the colours of the parser and of the syntax file, whatever a colour scheme defines for servers,
--- so that no colour changes when the server responds. The table is from `grammar/colours.json`.

local M = {}

--- The parser's capture for each type of semantic token.
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

--- Links the highlight groups of semantic tokens to the parser's; groups that a colour scheme defines are kept.
function M.link()
  for token_type, capture in pairs(CAPTURES) do
    local group = ('@lsp.type.%s.pydslrep'):format(token_type)
    vim.api.nvim_set_hl(0, group, { link = ('@%s.pydslrep'):format(capture), default = true })
  end
end

return M
