/** The folder of the extension; put in when the tests are bundled. */
declare const EXTENSION_FOLDER: string;
