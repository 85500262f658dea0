// The colours of the picture, which the style sheet derives from the editor's theme.

export interface Theme {
  background: string;
  foreground: string;
  muted: string;
  grid: string;
  axis: string;
  obstacle: string;
  obstacleEdge: string;
  collision: string;
  highlight: string;
  robots: string[];
  font: string;
  /** Areas are then outlined rather than tinted. */
  isHighContrast: boolean;
}

/** Further robots reuse the colours. */
export const ROBOT_COLOURS = 6;

export function readTheme(body: HTMLElement): Theme {
  const style = getComputedStyle(body);
  const value = (name: string): string => style.getPropertyValue(name).trim();
  return {
    background: value("--background"),
    foreground: value("--foreground"),
    muted: value("--muted"),
    grid: value("--grid"),
    axis: value("--axis"),
    obstacle: value("--obstacle"),
    obstacleEdge: value("--obstacle-edge"),
    collision: value("--collision"),
    highlight: value("--highlight"),
    robots: Array.from({ length: ROBOT_COLOURS }, (_, index) => value(`--robot-${index}`)),
    font: style.fontFamily,
    isHighContrast: body.classList.contains("vscode-high-contrast") || body.classList.contains("vscode-high-contrast-light"),
  };
}

export function robotColour(theme: Theme, index: number): string {
  return theme.robots[index % ROBOT_COLOURS] ?? theme.foreground;
}

/** Calls back when the editor's theme changes. */
export function watchTheme(changed: () => void): void {
  const observer = new MutationObserver(changed);
  observer.observe(document.body, { attributes: true, attributeFilter: ["class", "data-vscode-theme-id"] });
  observer.observe(document.documentElement, { attributes: true, attributeFilter: ["style"] });
}
