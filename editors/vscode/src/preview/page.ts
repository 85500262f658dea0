// The HTML of the preview's page and its content security policy.

export interface PageParts {
  /** The origin of scripts and styles, for the policy. */
  source: string;
  script: string;
  style: string;
  /** Unique for each page. */
  nonce: string;
}

/** The page. It loads nothing from the network or the program, and runs only the extension's script. */
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
