; TODO and FIXME, links
((comment) @injection.content
  (#set! injection.language "comment"))
