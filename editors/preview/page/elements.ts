// Creates elements of the page.

/** An element with attributes and children. */
export function element<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Record<string, string> = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[Tag] {
  const created = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) created.setAttribute(name, value);
  created.append(...children);
  return created;
}

/** An icon for a button; the shape is an SVG path in a square of 16. */
export function icon(shape: string): SVGSVGElement {
  const namespace = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(namespace, "svg");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS(namespace, "path");
  path.setAttribute("d", shape);
  svg.append(path);
  return svg;
}

export const ICONS = {
  play: "M4 2.5v11l9.5-5.5z",
  pause: "M4 3h3v10H4zM9 3h3v10H9z",
  plus: "M7.25 3h1.5v4.25H13v1.5H8.75V13h-1.5V8.75H3v-1.5h4.25z",
  minus: "M3 7.25h10v1.5H3z",
  export: "M7.25 2h1.5v6.2l2-2L11.8 7.3 8 11.1 4.2 7.3l1.05-1.1 2 2zM2.5 10H4v2.5h8V10h1.5v4h-11z",
  help: "M8 1.5a6.5 6.5 0 1 1 0 13 6.5 6.5 0 0 1 0-13zm0 1.4a5.1 5.1 0 1 0 0 10.2A5.1 5.1 0 0 0 8 2.9zM7.3 10.300h1.400v1.400H7.300zM8 4.300c1.500 0 2.500.9 2.500 2.200 0 1-.6 1.500-1.100 1.900-.5.4-.7.600-.7 1.100v.1H7.300v-.2c0-1.100.6-1.600 1.100-2 .5-.4.7-.5.7-.9 0-.5-.4-.9-1.100-.9-.7 0-1.200.4-1.300 1.100H5.300C5.400 5.200 6.500 4.300 8 4.300z",
  fit: "M2 2h4.5v1.5h-3v3H2zM9.5 2H14v4.5h-1.5v-3h-3zM2 9.5h1.5v3h3V14H2zM12.5 9.5H14V14H9.5v-1.5h3z",
};

/** The tag of the focused element; checkboxes differ from other inputs. */
export function focusOf(target: EventTarget | null): string {
  if (target instanceof HTMLInputElement && target.type === "checkbox") return "CHECKBOX";
  return target instanceof HTMLElement ? target.tagName : "";
}
