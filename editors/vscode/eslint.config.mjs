import tseslint from "typescript-eslint";

import rules from "../preview/rules.mjs";

export default tseslint.config(
  { ignores: ["dist/", "node_modules/", "packaging/", "server/"] },
  {
    files: ["src/**/*.ts", "tests/**/*.ts", "webview/**/*.ts", "web/**/*.ts"],
    extends: [tseslint.configs.strictTypeChecked, tseslint.configs.stylisticTypeChecked],
    languageOptions: {
      parserOptions: { project: ["./tsconfig.json", "./webview/tsconfig.json", "./web/tsconfig.json"], tsconfigRootDir: import.meta.dirname },
    },
    rules,
  },
);
