" Highlights programs without the tree-sitter parser and the server, as far as neighbouring words allow. Tests compare the
" keywords with the language's list and the colours with those of the server.
if exists('b:current_syntax')
  finish
endif
let s:cpo = &cpo
set cpo&vim

syn case match

" A keyword before a name determines the kind of the name.
syn keyword pydslrepKeyword wheel wheelH nextgroup=pydslrepWheel skipwhite skipempty
syn keyword pydslrepKeyword sensor nextgroup=pydslrepSensor skipwhite skipempty
syn keyword pydslrepKeyword ip nextgroup=pydslrepIp skipwhite skipempty
syn keyword pydslrepKeyword robot of nextgroup=pydslrepRobot skipwhite skipempty
syn keyword pydslrepKeyword movement nextgroup=pydslrepMovement skipwhite skipempty
syn keyword pydslrepKeyword environment nextgroup=pydslrepEnvironment skipwhite skipempty
" The other keywords, which crates/syntax/tests/keywords.rs writes.
syn keyword pydslrepKeyword with radius type tw fw fwh port has wheels sensors parallel move meters centimeters at
syn keyword pydslrepKeyword turn left right until slam robots moves
" End of the keywords.

" Names; those of unknown kind have no colour.
syn match pydslrepWheel /\^\=\<\h\w*/ contained
syn match pydslrepSensor /\^\=\<\h\w*/ contained nextgroup=pydslrepSensorKind skipwhite skipempty
syn match pydslrepIp /\^\=\<\h\w*/ contained
syn match pydslrepRobot /\^\=\<\h\w*/ contained
syn match pydslrepMovement /\^\=\<\h\w*/ contained
syn match pydslrepEnvironment /\^\=\<\h\w*/ contained
syn match pydslrepName /\^\h\w*/

" The contextual keywords, which crates/syntax/tests/keywords.rs writes; they are names in lists and after `do`.
syn keyword pydslrepWord contained wait seconds repeat times if else in reverse clear detect within
" End of the contextual keywords.
syn keyword pydslrepWord contained do nextgroup=pydslrepMovement skipwhite skipempty
syn match pydslrepSensorKind /:\_s*\%(distance\|bumper\)\>/ contained contains=pydslrepKind
syn keyword pydslrepKind contained distance bumper
syn match pydslrepImport /\<import\>\%(\_s*"\)\@=/

syn match pydslrepNumber /-\=\<\d\+\%(\.\d\+\)*\>/
syn match pydslrepString /"[^"]*"/

" Braces: bodies of movements and their blocks, which fold, and lists, whose kind depends on the keyword next to them.
syn region pydslrepBody start=/{/ end=/}/ transparent fold
      \ contains=ALLBUT,pydslrepWheel,pydslrepSensor,pydslrepSensorKind,pydslrepKind,pydslrepIp,pydslrepRobot,
      \pydslrepMovement,pydslrepEnvironment
let s:list = '{\%(/\*\_.\{-}\*/\|//.*\|\_[^{}]\)*}'
let s:of = ' contains=pydslrepLineComment,pydslrepBlockComment,'
exe 'syn match pydslrepWheels #' .. s:list .. '\%(\_s*wheels\>\)\@=#' .. s:of .. 'pydslrepWheel'
exe 'syn match pydslrepRobots #' .. s:list .. '\%(\_s*robots\>\)\@=#' .. s:of .. 'pydslrepRobot'
exe 'syn match pydslrepMoves #' .. s:list .. '\%(\_s*moves\>\)\@=#' .. s:of .. 'pydslrepMovement'
" `if` is a robot in `movement m of if {`.
let s:before = '\%(\%(\<\%(sensors\|until\)\|\%(\<of\_s\+\)\@<!\<if\)\_s*\)\@<='
exe 'syn match pydslrepSensors #' .. s:before .. s:list .. '#' .. s:of .. 'pydslrepSensor'
unlet s:list s:of s:before

syn match pydslrepLineComment "//.*$" contains=@Spell
syn region pydslrepBlockComment start="/\*" end="\*/" contains=@Spell fold

" Parses long lists and comments from their start.
syn sync minlines=200

" The groups that semantic tokens are linked to, so that no colour changes when the server responds.
hi def link pydslrepKeyword @keyword
hi def link pydslrepKind @keyword
hi def link pydslrepImport @keyword
hi def link pydslrepWord @keyword
hi def link pydslrepWheel @variable
hi def link pydslrepSensor @property
hi def link pydslrepIp @constant
hi def link pydslrepRobot @type
hi def link pydslrepMovement @function
hi def link pydslrepEnvironment @module
hi def link pydslrepNumber @number
hi def link pydslrepString @string
hi def link pydslrepLineComment @comment
hi def link pydslrepBlockComment @comment

let b:current_syntax = 'pydslrep'
let &cpo = s:cpo
unlet s:cpo
