;; Company, which completes from the first letter without delay; braces are closed.
(require 'company)
(setq company-idle-delay 0.0 company-minimum-prefix-length 1)
(global-company-mode)
(electric-pair-mode)
