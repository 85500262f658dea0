// Markdown of the server contains text of the program, which may be anybody's: only plain formatting is kept.
import purify, { type Config } from "dompurify";

const FORMATTING: Config = {
  ALLOWED_TAGS: "a b blockquote br code del em h1 h2 h3 h4 hr i li ol p pre span strong table tbody td th thead tr ul".split(" "),
  ALLOWED_ATTR: ["class", "href"],
  ALLOWED_URI_REGEXP: /^https:\/\//,
  ALLOW_ARIA_ATTR: false,
  ALLOW_DATA_ATTR: false,
};

purify.addHook("afterSanitizeAttributes", (element) => {
  if (element.hasAttribute("href")) {
    element.setAttribute("target", "_blank");
    element.setAttribute("rel", "noopener noreferrer");
  }
});

/** Removes everything from HTML but the elements of formatted text, with no attributes but links and classes of colours. */
export function sanitize(html: string): string {
  return purify.sanitize(html, FORMATTING);
}
