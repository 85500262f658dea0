;; Company, which completes from the first letter on and without delay; braces are closed.
(add-to-list 'load-path "COMPANY")
(require 'company)
(setq company-idle-delay 0.0 company-minimum-prefix-length 1)
(global-company-mode)
(electric-pair-mode)
