// Tabs by the keyboard pattern of the ARIA guide: arrows move between them, and the chosen one is the one in the tab order.

export class Tabs {
  private readonly tabs: HTMLButtonElement[];

  constructor(
    list: HTMLElement,
    private readonly chosen: (name: string) => void,
  ) {
    this.tabs = [...list.querySelectorAll<HTMLButtonElement>('[role="tab"]')];
    for (const tab of this.tabs) tab.addEventListener("click", () => this.choose(nameOf(tab)));
    list.addEventListener("keydown", (event) => this.move(event));
  }

  get shown(): string {
    return nameOf(this.tabs.find((tab) => tab.ariaSelected === "true") ?? this.tabs[0]);
  }

  choose(name: string): void {
    for (const tab of this.tabs) {
      const isChosen = nameOf(tab) === name;
      tab.ariaSelected = `${isChosen}`;
      tab.tabIndex = isChosen ? 0 : -1;
    }
    this.chosen(name);
  }

  /** Shows a number of problems on a tab. */
  mark(name: string, errors: number, warnings: number): void {
    const tab = this.tabs.find((found) => nameOf(found) === name);
    const badge = tab?.querySelector<HTMLElement>(".badge");
    if (!badge) return;
    badge.dataset.severity = errors > 0 ? "error" : "warning";
    badge.textContent = errors + warnings > 0 ? `${errors || warnings}` : "";
    const words = [counted(errors, "error"), counted(warnings, "warning")].filter(Boolean).join(", ");
    badge.setAttribute("aria-label", words);
    badge.hidden = words === "";
  }

  private move(event: KeyboardEvent): void {
    const index = this.tabs.findIndex((tab) => nameOf(tab) === this.shown);
    const last = this.tabs.length - 1;
    const next = { ArrowRight: index === last ? 0 : index + 1, ArrowLeft: index === 0 ? last : index - 1, Home: 0, End: last }[event.key];
    const tab = next === undefined ? undefined : this.tabs[next];
    if (!tab) return;
    event.preventDefault();
    tab.focus();
    this.choose(nameOf(tab));
  }
}

function nameOf(tab: HTMLElement | undefined): string {
  return tab?.dataset.tab ?? "";
}

function counted(count: number, what: string): string {
  return count === 0 ? "" : `${count} ${what}${count === 1 ? "" : "s"}`;
}
