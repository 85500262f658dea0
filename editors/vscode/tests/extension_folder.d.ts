/** The extension's folder, defined when the tests are bundled. */
declare const EXTENSION_FOLDER: string;
