// Written by a test of crates/server/src/driven.rs.
import type { DrivenRobot } from "../host/protocol";

export const robots: DrivenRobot[] = [
  {
    "name": "a",
    "poses": [
      {
        "t": 0.0,
        "x": 1.0,
        "y": 0.0,
        "theta": 0.0
      }
    ],
    "map": {
      "nodes": [
        [
          0.0,
          1.0
        ],
        [
          2.0,
          3.0
        ]
      ],
      "edges": [
        [
          [
            0.0,
            1.0
          ],
          [
            2.0,
            3.0
          ]
        ]
      ]
    }
  }
];
