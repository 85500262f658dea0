// Colours for pages outside VS Code: the classes that it gives a page. `colours.css` has the variables.

export type Colours = "light" | "dark" | "high-contrast" | "high-contrast-light";

export function setColours(colours: Colours): void {
  document.documentElement.dataset.colours = colours;
  // The page redraws when its classes change.
  document.body.className = `vscode-${colours}`;
}

/** Uses the colours that the browser prefers, now and whenever that changes. */
export function followBrowserColours(): void {
  const [dark, contrast] = [matchMedia("(prefers-color-scheme: dark)"), matchMedia("(prefers-contrast: more)")];
  const update = () => setColours(contrast.matches ? (dark.matches ? "high-contrast" : "high-contrast-light") : dark.matches ? "dark" : "light");
  for (const query of [dark, contrast]) query.addEventListener("change", update);
  update();
}
