// Markdown of the server contains text of the program, which may be anybody's: only plain formatting is kept.

const ELEMENTS = new Set("A B BLOCKQUOTE BR CODE DEL EM H1 H2 H3 H4 HR I LI OL P PRE SPAN STRONG TABLE TBODY TD TH THEAD TR UL".split(" "));

/** Removes everything from HTML but the elements of formatted text, with no attributes but links and classes of colours. */
export function sanitize(html: string): string {
  const { body } = new DOMParser().parseFromString(html, "text/html");
  for (const found of [...body.querySelectorAll("*")]) {
    if (!ELEMENTS.has(found.tagName)) {
      found.replaceWith(found.textContent);
      continue;
    }
    for (const { name, value } of [...found.attributes]) {
      if (!(name === "class" || (name === "href" && value.startsWith("https://")))) found.removeAttribute(name);
    }
    if (found.hasAttribute("href")) {
      found.setAttribute("target", "_blank");
      found.setAttribute("rel", "noopener noreferrer");
    }
  }
  return body.innerHTML;
}
