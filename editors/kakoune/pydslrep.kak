# PyDSLRep for Kakoune: highlights keywords, numbers and comments; kakoune-lsp highlights names.

hook global BufCreate .*[.]pyr %{ set-option buffer filetype pydslrep }
hook global BufCreate (.*/)?(pydslrep|[^/]*[.]scene)[.]toml %{ set-option buffer filetype toml }

add-highlighter shared/pydslrep regions
add-highlighter shared/pydslrep/line region '//' '$' fill comment
add-highlighter shared/pydslrep/block region '/\*' '\*/' fill comment
add-highlighter shared/pydslrep/string region '"' '"|$' fill string
add-highlighter shared/pydslrep/code default-region group
# The keywords, which crates/syntax/tests/keywords.rs writes.
add-highlighter shared/pydslrep/code/ regex '(?<![\w^])(wheel|wheelH|with|radius|sensor|ip|robot|type|tw|fw|fwh|port|has|wheels|sensors|parallel|movement|of|move|meters|centimeters|at|turn|left|right|until|slam|environment|robots|moves)(?!\w)' 0:keyword
# End of the keywords.
add-highlighter shared/pydslrep/code/ regex '^\h*(import)\h*(?=")' 1:keyword
add-highlighter shared/pydslrep/code/ regex ':\s*(distance|bumper)(?!\w)' 1:keyword
# Contextual keywords, as far as their neighbours tell; each is a name elsewhere.
# The actions before a number, which crates/syntax/tests/keywords.rs writes.
add-highlighter shared/pydslrep/code/ regex '(?<!ip\s)(?<![\w^])(wait|repeat)\s+(?:-?\d+(?:\.\d+)?(?![.\d])|until(?!\w))' 1:keyword
# End of the actions before a number.
add-highlighter shared/pydslrep/code/ regex '(?<![\w^.])-?\d+(?:\.\d+)?\s*(seconds|times)(?!\w)' 1:keyword
add-highlighter shared/pydslrep/code/ regex '(?<!of\s)(?<![\w^])(if)\s*\{' 1:keyword
add-highlighter shared/pydslrep/code/ regex '\}\s*(else)(?!\w)' 1:keyword
add-highlighter shared/pydslrep/code/ regex '\}\s*(clear|detect)(?!\w)' 1:keyword
add-highlighter shared/pydslrep/code/ regex '(?:\}|(?<![\w^])(?:clear|detect))\s*(?<![\w^])(within)\s+-?\d' 1:keyword
add-highlighter shared/pydslrep/code/ regex '(?:(?<![\w^])(?:left|right|meters|centimeters)\s|(?<![\w^])-?\d+(?:\.\d+)?)\s*(in)\s+(reverse)(?!\w)' 1:keyword 2:keyword
add-highlighter shared/pydslrep/code/ regex '(?:^\s*|\}\s*|(?<![\w^])(?:of\s+\^?\w+|times|clear|detect|else|meters|centimeters)\s*\{\s*|(?<![\w^])(?:slam|left|right|meters|centimeters)\s+|(?<![\w^.])-?\d+(?:\.\d+)?\s+)(do)\s+(\^?[A-Za-z_]\w*)' 1:keyword 2:function
add-highlighter shared/pydslrep/code/ regex '(?<!\w)-?\d+(\.\d+)*' 0:value

hook -group pydslrep-highlight global WinSetOption filetype=pydslrep %{
    add-highlighter window/pydslrep ref pydslrep
    hook -once -always window WinSetOption filetype=.* %{ remove-highlighter window/pydslrep }
}

hook global WinSetOption filetype=pydslrep %{
    set-option window indentwidth 2
    set-option window comment_line '//'
    set-option window comment_block_begin '/*'
    set-option window comment_block_end '*/'
    hook -group pydslrep-indent window InsertChar \n pydslrep-indent-on-new-line
    hook -group pydslrep-indent window InsertChar \x7d pydslrep-indent-on-closing-brace
    hook -once -always window WinSetOption filetype=.* %{ remove-hooks window pydslrep-indent }
}

define-command -hidden pydslrep-indent-on-new-line %~
    evaluate-commands -draft -itersel %_
        # Copies the indentation of the line before and removes its trailing blanks.
        try %{ execute-keys -draft <semicolon> K <a-&> }
        try %{ execute-keys -draft k x s \h+$ <ret> d }
        # Indents after an opening brace.
        try %[ execute-keys -draft k x <a-k> \{\h*(//[^\n]*)?$ <ret> j <a-gt> ]
    _
~

define-command -hidden pydslrep-indent-on-closing-brace %~
    # Aligns a closing brace with the line of its opening brace.
    try %[ execute-keys -draft <a-h> <a-k> ^\h+\}$ <ret> m <a-S> 1 <a-&> ]
~

hook -group lsp-filetype-pydslrep global BufSetOption filetype=pydslrep %{
    set-option buffer lsp_servers %{
        [pydslrep-lsp]
        args = ["--stdio"]
        root_globs = ["pydslrep.toml", ".git"]
    }
    # Faces of Kakoune's own colour schemes.
    set-option buffer lsp_semantic_tokens %{
        [
            {face="comment", token="comment"},
            {face="keyword", token="keyword"},
            {face="value", token="number"},
            {face="string", token="string"},
            {face="variable", token="variable"},
            {face="attribute", token="property"},
            {face="builtin", token="enumMember"},
            {face="type", token="class"},
            {face="function", token="function"},
            {face="module", token="namespace"},
        ]
    }
}

hook global WinSetOption filetype=pydslrep %{
    lsp-enable-window
    lsp-inlay-diagnostics-enable window
    lsp-inlay-hints-enable window
    hook -group pydslrep-tokens window BufReload .* lsp-semantic-tokens
    hook -group pydslrep-tokens window NormalIdle .* lsp-semantic-tokens
    hook -group pydslrep-tokens window InsertIdle .* lsp-semantic-tokens
    hook -once -always window WinSetOption filetype=.* %{ remove-hooks window pydslrep-tokens }
}

define-command pydslrep-preview -docstring 'show the address of a page with the planned path, which follows the text' %{
    lsp-execute-command pydslrep.openPreview '[]'
}
