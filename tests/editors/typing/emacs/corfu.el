;; Corfu, which completes from the first letter after 50 ms; braces are closed.
(require 'corfu)
(require 'corfu-terminal)
(setq corfu-auto t corfu-auto-delay 0.05 corfu-auto-prefix 1)
(global-corfu-mode)
(corfu-terminal-mode)
(electric-pair-mode)
