// The list of keys, shown over the picture.
import { element } from "./elements";
import { KEYS } from "./keys";

export class Help {
  readonly box: HTMLElement;

  constructor() {
    const rows = KEYS.flatMap(({ label, effect }) => [
      element("dt", {}, ...label.split(" ").flatMap((key) => [element("kbd", {}, key), " "])),
      element("dd", {}, effect),
    ]);
    this.box = element("section", { class: "help", role: "dialog", "aria-label": "Keys", "data-part": "help", tabindex: "-1" }, element("dl", {}, ...rows));
    this.box.hidden = true;
  }

  toggle(): void {
    this.box.hidden = !this.box.hidden;
    // So that screen readers read the list.
    if (!this.box.hidden) this.box.focus();
  }

  hide(): void {
    this.box.hidden = true;
  }
}
