// The browser side of the path preview.
export {};
