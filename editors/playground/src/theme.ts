// Light or dark: as the system has it, until the user chooses.

const KEY = "pydslrep.theme";
const isSystemDark = matchMedia("(prefers-color-scheme: dark)");

export type Theme = "light" | "dark";

/** Follows the system and the button; `changed` gets every theme that is shown, from the first. */
export function followTheme(toggle: HTMLButtonElement, changed: (theme: Theme) => void): void {
  const apply = (): void => {
    const theme = shown();
    document.documentElement.dataset.theme = theme;
    toggle.ariaPressed = `${theme === "dark"}`;
    changed(theme);
  };
  toggle.addEventListener("click", () => {
    store(shown() === "dark" ? "light" : "dark");
    apply();
  });
  isSystemDark.addEventListener("change", apply);
  apply();
}

function shown(): Theme {
  const chosen = stored();
  if (chosen === "light" || chosen === "dark") return chosen;
  return isSystemDark.matches ? "dark" : "light";
}

// Storage may be forbidden.

function stored(): string | null {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null;
  }
}

function store(theme: Theme): void {
  try {
    localStorage.setItem(KEY, theme);
  } catch {
  }
}
