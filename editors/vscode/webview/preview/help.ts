// The list of keys, over the picture.
import { element } from "./elements";
import { KEYS } from "./keys";

export class Help {
  readonly box: HTMLElement;

  constructor() {
    const rows = KEYS.flatMap(({ shown, does }) => [
      element("dt", {}, ...shown.split(" ").flatMap((key) => [element("kbd", {}, key), " "])),
      element("dd", {}, does),
    ]);
    this.box = element("section", { class: "help", role: "dialog", "aria-label": "Keys", "data-part": "help", tabindex: "-1" }, element("dl", {}, ...rows));
    this.box.hidden = true;
  }

  toggle(): void {
    this.box.hidden = !this.box.hidden;
    // Whoever cannot see it hears it.
    if (!this.box.hidden) this.box.focus();
  }

  hide(): void {
    this.box.hidden = true;
  }
}
