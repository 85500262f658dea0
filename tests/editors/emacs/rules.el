;;; rules.el --- The mode's own rules, without the parser -*- lexical-binding: t -*-

;;; Commentary:

;; check.py runs it in batch mode, with the mode loaded.

;;; Code:

(require 'ert)

(defconst rules-program "\
robot if with port 1 has { wait repeat } wheels with sensors { clear, detect }
movement times of if {
  repeat 4 times {
    do wait
    do do
    do // what is done
      if
    wait 2 seconds until { wait within } clear within 1 meters
  }
  repeat until {
    else
    in
  } detect {
    if { do } clear {
      turn left in reverse
    } else {
      slam
    }
  }
}
environment else has { if } robots with { times } moves
")

(defun rules--with-face (face)
  "Return the words of the program that have FACE, in order."
  (with-temp-buffer
    (insert rules-program)
    (pydslrep-mode)
    (font-lock-ensure)
    (goto-char (point-min))
    (let (found)
      (while (re-search-forward "\\_<[a-z]+\\_>" nil t)
        (when (eq (get-text-property (match-beginning 0) 'face) face)
          (push (match-string 0) found)))
      (string-join (nreverse found) " "))))

(ert-deftest rules-contextual-words-are-keywords-in-actions-only ()
  (should (equal (rules--with-face 'font-lock-keyword-face)
                 (concat "robot with port has wheels with sensors movement of repeat times do do do"
                         " wait seconds until clear within meters repeat until detect if clear turn left"
                         " in reverse else slam environment has robots with moves"))))

(ert-deftest rules-movements-follow-do ()
  (should (equal (rules--with-face 'font-lock-function-call-face) "wait do if")))

(ert-deftest rules-blocks-are-indented ()
  (with-temp-buffer
    (insert (replace-regexp-in-string "^ +" "" rules-program))
    (pydslrep-mode)
    (indent-region (point-min) (point-max))
    (should (equal (buffer-string) (replace-regexp-in-string "^      if" "    if" rules-program)))))

(provide 'rules)
;;; rules.el ends here
