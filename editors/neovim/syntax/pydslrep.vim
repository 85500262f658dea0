" Colours for programs where neither the tree-sitter parser nor the server is there: what can be told of a word by those
" beside it. A test holds the keywords against the language's own list, and the colours against those of the server.
if exists('b:current_syntax')
  finish
endif
let s:cpo = &cpo
set cpo&vim

syn case match

" Each word that is followed by a name says what the name stands for.
syn keyword pydslrepKeyword wheel wheelH nextgroup=pydslrepWheel skipwhite skipempty
syn keyword pydslrepKeyword sensor nextgroup=pydslrepSensor skipwhite skipempty
syn keyword pydslrepKeyword ip nextgroup=pydslrepIp skipwhite skipempty
syn keyword pydslrepKeyword robot of nextgroup=pydslrepRobot skipwhite skipempty
syn keyword pydslrepKeyword movement nextgroup=pydslrepMovement skipwhite skipempty
syn keyword pydslrepKeyword environment nextgroup=pydslrepEnvironment skipwhite skipempty
syn keyword pydslrepKeyword with radius type tw fw fwh port has wheels sensors parallel move meters centimeters at
syn keyword pydslrepKeyword turn left right until slam robots moves

" Names. Those in braces that nothing is known of have no colour, as anywhere else.
syn match pydslrepWheel /\^\=\<\h\w*/ contained
syn match pydslrepSensor /\^\=\<\h\w*/ contained nextgroup=pydslrepSensorKind skipwhite skipempty
syn match pydslrepIp /\^\=\<\h\w*/ contained
syn match pydslrepRobot /\^\=\<\h\w*/ contained
syn match pydslrepMovement /\^\=\<\h\w*/ contained
syn match pydslrepEnvironment /\^\=\<\h\w*/ contained
syn match pydslrepName /\^\h\w*/

" Words that are keywords at one place only.
syn match pydslrepSensorKind /:\_s*\%(distance\|bumper\)\>/ contained contains=pydslrepKind
syn keyword pydslrepKind contained distance bumper
syn match pydslrepImport /\<import\>\%(\_s*"\)\@=/

syn match pydslrepNumber /-\=\<\d\+\%(\.\d\+\)*\>/
syn match pydslrepString /"[^"]*"/

" Braces: the movement's, which fold, and lists, of which the words around them say what they list.
syn region pydslrepBody start=/{/ end=/}/ transparent fold
let s:list = '{\%(/\*\_.\{-}\*/\|//.*\|\_[^{}]\)*}'
let s:of = ' contains=pydslrepLineComment,pydslrepBlockComment,'
exe 'syn match pydslrepWheels #' .. s:list .. '\%(\_s*wheels\>\)\@=#' .. s:of .. 'pydslrepWheel'
exe 'syn match pydslrepRobots #' .. s:list .. '\%(\_s*robots\>\)\@=#' .. s:of .. 'pydslrepRobot'
exe 'syn match pydslrepMoves #' .. s:list .. '\%(\_s*moves\>\)\@=#' .. s:of .. 'pydslrepMovement'
exe 'syn match pydslrepSensors #\%(\<\%(sensors\|until\)\_s*\)\@<=' .. s:list .. '#' .. s:of .. 'pydslrepSensor'
unlet s:list s:of

syn match pydslrepLineComment "//.*$" contains=@Spell
syn region pydslrepBlockComment start="/\*" end="\*/" contains=@Spell fold

" Lists and comments of any length are seen whole.
syn sync minlines=200

" The groups that the server's words lead to, so that nothing changes its colour when the server comes.
hi def link pydslrepKeyword @keyword
hi def link pydslrepKind @keyword
hi def link pydslrepImport @keyword
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
