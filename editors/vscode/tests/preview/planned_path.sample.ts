// Written by a test of crates/ide/src/planned_path.rs.
import type { PlannedPath } from "../../src/preview/protocol";

export const path: PlannedPath = {
  "environment": "e",
  "duration": null,
  "robots": [
    {
      "name": "rover",
      "body": {
        "length": 0.3,
        "width": 0.3
      },
      "sensors": [
        {
          "name": "front",
          "x": 0.15,
          "y": 0.0,
          "theta": 0.0,
          "range": 1.0,
          "cone": 0.3490658503988659
        }
      ],
      "poses": [
        {
          "t": 0.0,
          "x": 0.0,
          "y": 0.0,
          "theta": 0.0,
          "action": null
        },
        {
          "t": 1.4113888888888888,
          "x": 0.11892499999999998,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters"
          }
        },
        {
          "t": 2.8227777777777776,
          "x": 0.24595,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters"
          }
        },
        {
          "t": 4.234166666666667,
          "x": 0.372975,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters"
          }
        },
        {
          "t": 5.645555555555555,
          "x": 0.49999999999999994,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters"
          }
        },
        {
          "t": 7.056944444444444,
          "x": 0.6270249999999999,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters"
          }
        },
        {
          "t": 8.468333333333334,
          "x": 0.75405,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters"
          }
        },
        {
          "t": 9.879722222222222,
          "x": 0.8810749999999999,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters"
          }
        },
        {
          "t": 11.29111111111111,
          "x": 1.0,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters"
          }
        }
      ],
      "legs": [
        {
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters"
          },
          "start": 0.0,
          "duration": 11.29111111111111,
          "last": 8
        }
      ],
      "unknownAfter": {
        "movement": "m",
        "index": 1,
        "text": "turn left until { front }"
      }
    }
  ],
  "obstacles": [
    {
      "name": "pole",
      "centre": [
        0.5,
        0.0
      ],
      "radius": 0.1
    },
    {
      "name": "crate",
      "corners": [
        [
          3.5,
          3.5
        ],
        [
          2.5,
          3.5
        ],
        [
          2.5,
          2.5
        ],
        [
          3.5,
          2.5
        ]
      ]
    }
  ],
  "collisions": [
    {
      "robot": "rover",
      "action": {
        "movement": "m",
        "index": 0,
        "text": "move 1 meters"
      },
      "t": 2.862222222222222,
      "x": 0.24949999999999997,
      "y": 0.0,
      "theta": 0.0,
      "with": {
        "obstacle": "pole"
      }
    }
  ]
};
