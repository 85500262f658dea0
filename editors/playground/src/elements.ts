// Short ways to find and make elements.
import { element } from "../../preview/page/elements";

export { element };

// The caller knows which it is.
/* eslint-disable @typescript-eslint/no-unnecessary-type-parameters */
/** The element with an id of `index.html`. */
export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (found === null) throw new Error(`no element ${id}`);
  return found as T;
}

/* eslint-enable @typescript-eslint/no-unnecessary-type-parameters */

/** A button; `press` is called when it is pressed. */
export function button(label: string, press: () => void, attributes: Record<string, string> = {}): HTMLButtonElement {
  const made = element("button", { type: "button", ...attributes }, label);
  made.addEventListener("click", press);
  return made;
}
