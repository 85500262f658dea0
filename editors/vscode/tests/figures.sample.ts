// Written by a test of crates/cli/src/run/outcome.rs.
import type { Figures } from "../src/figures";

export const figures: Figures = {
  "environment": "yard",
  "complete": true,
  "planned": 10.04,
  "simulated": 10.06,
  "wall": 0.55,
  "robots": [
    {
      "name": "rover",
      "planned": {
        "x": 1.0,
        "y": 0.0,
        "theta": 0.5
      },
      "driven": {
        "x": 1.001,
        "y": 0.0,
        "theta": 0.5
      },
      "off": {
        "distance": 0.001,
        "angle": 0.0
      }
    },
    {
      "name": "idle",
      "planned": null,
      "driven": null,
      "off": null
    }
  ]
};
