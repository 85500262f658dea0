// The colours of the picture, as the style sheet has them for the editor's theme.

export interface Theme {
  paper: string;
  ink: string;
  quiet: string;
  grid: string;
  axis: string;
  obstacle: string;
  obstacleEdge: string;
  crash: string;
  highlight: string;
  robots: string[];
  font: string;
  /** Whether areas are outlined rather than tinted. */
  isHighContrast: boolean;
}

/** How many colours there are for robots; further ones begin anew. */
export const ROBOT_COLOURS = 6;

export function readTheme(body: HTMLElement): Theme {
  const style = getComputedStyle(body);
  const value = (name: string): string => style.getPropertyValue(name).trim();
  return {
    paper: value("--paper"),
    ink: value("--ink"),
    quiet: value("--quiet"),
    grid: value("--grid"),
    axis: value("--axis"),
    obstacle: value("--obstacle"),
    obstacleEdge: value("--obstacle-edge"),
    crash: value("--crash"),
    highlight: value("--highlight"),
    robots: Array.from({ length: ROBOT_COLOURS }, (_, index) => value(`--robot-${index}`)),
    font: style.fontFamily,
    isHighContrast: body.classList.contains("vscode-high-contrast") || body.classList.contains("vscode-high-contrast-light"),
  };
}

export function robotColour(theme: Theme, index: number): string {
  return theme.robots[index % ROBOT_COLOURS] ?? theme.ink;
}

/** Calls back when the editor's theme changes. */
export function watchTheme(changed: () => void): void {
  const observer = new MutationObserver(changed);
  observer.observe(document.body, { attributes: true, attributeFilter: ["class", "data-vscode-theme-id"] });
  observer.observe(document.documentElement, { attributes: true, attributeFilter: ["style"] });
}
