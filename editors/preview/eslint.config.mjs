import tseslint from "typescript-eslint";

import rules from "./rules.mjs";

export default tseslint.config(
  { ignores: ["dist/", "node_modules/"] },
  {
    files: ["**/*.ts"],
    extends: [tseslint.configs.strictTypeChecked, tseslint.configs.stylisticTypeChecked],
    languageOptions: {
      parserOptions: { project: ["./tsconfig.json", "./page/tsconfig.json", "./live/tsconfig.json"], tsconfigRootDir: import.meta.dirname },
    },
    rules,
  },
);
