// The panel's page: what may run in it, and where its parts come from.

export interface PageParts {
  /** The source of scripts and styles, as a content security policy names it. */
  source: string;
  script: string;
  style: string;
  /** Made anew for each page. */
  nonce: string;
}

/** The page. Nothing in it comes from a network or from the program, and only our own script runs. */
export function page({ source, script, style, nonce }: PageParts): string {
  const policy = `default-src 'none'; style-src ${source}; script-src 'nonce-${nonce}';`;
  return `<!DOCTYPE html>
<html lang="en">
<head>
  <meta charset="UTF-8">
  <meta http-equiv="Content-Security-Policy" content="${policy}">
  <meta name="viewport" content="width=device-width, initial-scale=1">
  <link rel="stylesheet" href="${style}">
  <title>Path Preview</title>
</head>
<body>
  <script nonce="${nonce}" src="${script}"></script>
</body>
</html>`;
}
