;;; pydslrep-mode.el --- Major mode for PyDSLRep -*- lexical-binding: t -*-

;; License: MIT
;; Package-Requires: ((emacs "29.1"))

;;; Commentary:

;; Highlighting, indentation and comments for PyDSLRep programs (*.pyr), and the language server with eglot.
;;
;; If the tree-sitter parser is installed (with `treesit-install-language-grammar', or see the README), all names are
;; highlighted by their kind; otherwise, keywords, numbers and declarations are.

;;; Code:

(require 'seq)
(require 'treesit)

(defvar eglot-server-programs)
(declare-function eglot-current-server "eglot")
(declare-function jsonrpc-request "jsonrpc")

(defgroup pydslrep nil
  "PyDSLRep programs."
  :group 'languages)

(defcustom pydslrep-server '("pydslrep-lsp" "--stdio")
  "The command that starts the language server."
  :type '(repeat string))

;; The keywords, which crates/syntax/tests/keywords.rs writes.
(defconst pydslrep-keywords
  '(
    "wheel" "wheelH" "with" "radius" "sensor" "ip" "robot" "type" "tw" "fw" "fwh" "port" "has" "wheels" "sensors"
    "parallel" "movement" "of" "move" "meters" "centimeters" "at" "turn" "left" "right" "until" "slam" "environment"
    "robots" "moves")
  "The keywords; contextual ones are left out.")

(defconst pydslrep-keyword-tokens
  '(
    "wheel" "wheelH" "with" "radius" "sensor" "ip" "robot" "type" "tw" "fw" "fwh" "port" "has" "wheels" "sensors"
    "parallel" "movement" "of" "move" "meters" "centimeters" "at" "turn" "left" "right" "until" "environment"
    "robots" "moves" "distance" "bumper" "import" "wait" "seconds" "repeat" "times" "if" "else" "do" "in" "reverse"
    "clear" "detect" "within")
  "The keywords that are tokens of the parser.")

(defconst pydslrep-keyword-nodes
  '(
    slam)
  "The keywords that are nodes of the parser.")
;; End of the keywords.

(defvar pydslrep-mode-syntax-table
  (let ((table (make-syntax-table)))
    (modify-syntax-entry ?/ ". 124" table)
    (modify-syntax-entry ?* ". 23b" table)
    (modify-syntax-entry ?\n ">" table)
    (modify-syntax-entry ?_ "_" table)
    ;; `^robots' is a name.
    (modify-syntax-entry ?^ "_" table)
    (modify-syntax-entry ?\' "." table)
    table))

(defun pydslrep--declares (words face)
  "Return a rule that gives the name after one of WORDS a FACE."
  `(,(concat "\\_<\\(?:" words "\\)\\s-+\\(\\_<.+?\\_>\\)") 1 ',face))

(defconst pydslrep--action-words
  (regexp-opt
   (seq-difference pydslrep-keyword-tokens `(,@pydslrep-keywords "distance" "bumper" "import"))
   'symbols)
  "Matches the contextual words of actions.")

(defun pydslrep--in-actions-p ()
  "Return non-nil if the innermost brace around point is not that of a list."
  (when-let* ((brace (nth 1 (syntax-ppss))))
    (save-excursion
      (goto-char brace)
      (forward-comment (- (point)))
      (or (not (looking-back "\\_<\\(?:has\\|with\\|sensors\\|until\\|if\\)" (line-beginning-position)))
          ;; A robot of that name.
          (looking-back "\\_<of\\s-+if" (line-beginning-position))))))

(defun pydslrep--after-do-p ()
  "Return non-nil if the word before point is `do' and no name itself."
  (save-excursion
    (let (is-after)
      (while (progn
               (forward-comment (- (point)))
               (looking-back "\\_<do" (line-beginning-position)))
        (setq is-after (not is-after))
        (backward-char 2))
      is-after)))

(defun pydslrep--search-actions (regexp limit is-done)
  "Find the next word of an action that matches REGEXP, up to LIMIT.
If IS-DONE is non-nil, it is the name after `do'; otherwise, any other."
  (let (is-found)
    (while (and (not is-found) (re-search-forward regexp limit t))
      (save-excursion
        (save-match-data
          (goto-char (match-beginning 0))
          (setq is-found (and (eq (pydslrep--after-do-p) is-done) (pydslrep--in-actions-p))))))
    is-found))

(defun pydslrep--search-action-word (limit)
  "Find the next contextual word of an action that is no name, up to LIMIT."
  (pydslrep--search-actions pydslrep--action-words limit nil))

(defun pydslrep--search-done (limit)
  "Find the next name after `do', up to LIMIT."
  (pydslrep--search-actions "\\_<\\^?[A-Za-z_][A-Za-z0-9_]*\\_>" limit t))

(defvar pydslrep-font-lock-keywords
  `((,(regexp-opt pydslrep-keywords 'symbols) . 'font-lock-keyword-face)
    ("^\\s-*\\(import\\)\\s-*\"" 1 'font-lock-keyword-face)
    (":\\s-*\\(distance\\|bumper\\)\\_>" 1 'font-lock-keyword-face)
    (pydslrep--search-action-word . 'font-lock-keyword-face)
    (pydslrep--search-done . 'font-lock-function-call-face)
    ("\\_<-?[0-9]+\\(?:\\.[0-9]+\\)*" . 'font-lock-number-face)
    ,(pydslrep--declares "wheelH?" 'font-lock-variable-name-face)
    ,(pydslrep--declares "sensor" 'font-lock-property-name-face)
    ,(pydslrep--declares "ip" 'font-lock-constant-face)
    ,(pydslrep--declares "robot\\|of" 'font-lock-type-face)
    ,(pydslrep--declares "movement" 'font-lock-function-name-face)
    ,(pydslrep--declares "environment" 'font-lock-preprocessor-face))
  "Font lock rules without the parser.")

(defun pydslrep--font-lock-rules ()
  "Return font lock rules for the parser, with the captures of its highlights.scm."
  (treesit-font-lock-rules
   :language 'pydslrep :feature 'comment '((comment) @font-lock-comment-face)
   :language 'pydslrep :feature 'string '((string) @font-lock-string-face)
   :language 'pydslrep :feature 'keyword
   `([,@pydslrep-keyword-tokens] @font-lock-keyword-face
     ,@(mapcar (lambda (node) `((,node) @font-lock-keyword-face)) pydslrep-keyword-nodes))
   :language 'pydslrep :feature 'number '([(number) (address)] @font-lock-number-face)
   :language 'pydslrep :feature 'definition
   '((wheel_definition name: (name) @font-lock-variable-name-face)
     (sensor_definition name: (name) @font-lock-property-name-face)
     (ip_definition name: (name) @font-lock-constant-face)
     (robot_definition name: (name) @font-lock-type-face)
     (movement_definition name: (name) @font-lock-function-name-face)
     (environment_definition name: (name) @font-lock-preprocessor-face))
   :language 'pydslrep :feature 'reference
   '((wheel_references (name) @font-lock-variable-use-face)
     (sensor_references (name) @font-lock-property-use-face)
     (ip_clause ip: (name) @font-lock-constant-face)
     (movement_definition robot: (name) @font-lock-type-face)
     (robot_references (name) @font-lock-type-face)
     (movement_references (name) @font-lock-function-call-face)
     (do movement: (name) @font-lock-function-call-face))))

(defun pydslrep-indent-line ()
  "Indent the line by two for each open brace."
  (let* ((state (save-excursion (syntax-ppss (line-beginning-position))))
         (closes (save-excursion (back-to-indentation) (eq (char-after) ?})))
         (depth (- (car state) (if closes 1 0))))
    (unless (or (nth 3 state) (nth 4 state))
      (if (<= (current-column) (current-indentation))
          (indent-line-to (* 2 (max 0 depth)))
        (save-excursion (indent-line-to (* 2 (max 0 depth))))))))

;;;###autoload
(define-derived-mode pydslrep-mode prog-mode "PyDSLRep"
  "Major mode for PyDSLRep programs."
  (setq-local comment-start "// "
              comment-end ""
              comment-start-skip "\\(?://+\\|/\\*+\\)\\s-*"
              indent-tabs-mode nil
              indent-line-function #'pydslrep-indent-line)
  (setq-local electric-indent-chars (cons ?} electric-indent-chars))
  (if (not (treesit-ready-p 'pydslrep t))
      (setq-local font-lock-defaults '(pydslrep-font-lock-keywords))
    (treesit-parser-create 'pydslrep)
    (setq-local treesit-font-lock-settings (pydslrep--font-lock-rules)
                treesit-font-lock-feature-list '((comment definition) (keyword string) (number reference))
                treesit-defun-type-regexp "_definition\\'")
    (treesit-major-mode-setup)))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.pyr\\'" . pydslrep-mode))

;;;###autoload
(defun pydslrep-preview ()
  "Open the planned path of the program in a browser.
It follows the text and the cursor, and ends with the language server."
  (interactive)
  (let ((server (or (eglot-current-server) (user-error "Start the language server first: M-x eglot"))))
    ;; Eglot shows the page, or the message with its address.
    (jsonrpc-request server :workspace/executeCommand '(:command "pydslrep.openPreview" :arguments []))))

(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs `(pydslrep-mode . ,pydslrep-server)))

(provide 'pydslrep-mode)
;;; pydslrep-mode.el ends here
