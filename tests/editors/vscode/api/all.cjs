// All tests that run in the extension host.
const { running } = require("./asking.cjs");

exports.run = async () => {
  await running({ ...require("./tests.cjs"), ...require("./blocks.cjs") })();
  // At its end the extension host would end, and with it what the editor shows.
  await new Promise(() => undefined);
};
