// Written by a test of crates/ide/src/planned_path.rs.
import type { PlannedPath } from "../host/protocol";

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
          "t": 1.4301388888888888,
          "x": 0.12061249999999998,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              1
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 2.8602777777777777,
          "x": 0.249325,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              1
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 4.290416666666666,
          "x": 0.37803749999999997,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              1
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 5.720555555555555,
          "x": 0.50675,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              1
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 7.1506944444444445,
          "x": 0.6354625,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              1
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 8.580833333333333,
          "x": 0.7641749999999999,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              1
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 10.010972222222222,
          "x": 0.8928875,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              1
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 11.44111111111111,
          "x": 1.0,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              1
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 12.87125,
          "x": 1.1206125,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              2
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 14.301388888888889,
          "x": 1.249325,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              2
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 15.731527777777778,
          "x": 1.3780375,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              2
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 17.161666666666665,
          "x": 1.50675,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              2
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 18.591805555555556,
          "x": 1.6354625,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              2
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 20.021944444444443,
          "x": 1.7641749999999998,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              2
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 21.452083333333334,
          "x": 1.8928875,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              2
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        },
        {
          "t": 22.88222222222222,
          "x": 2.0,
          "y": 0.0,
          "theta": 0.0,
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              2
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          }
        }
      ],
      "legs": [
        {
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              1
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          },
          "start": 0.0,
          "duration": 11.44111111111111,
          "last": 8
        },
        {
          "action": {
            "movement": "m",
            "index": 0,
            "text": "move 1 meters",
            "rounds": [
              2
            ],
            "counts": [
              2
            ],
            "calls": [
              {
                "movement": "m",
                "index": 1
              }
            ],
            "done": "side"
          },
          "start": 11.44111111111111,
          "duration": 11.44111111111111,
          "last": 16
        }
      ],
      "unknownAfter": {
        "movement": "m",
        "index": 2,
        "text": "move 1 meters until { front } detect"
      },
      "possible": [
        {
          "poses": [
            {
              "t": 22.88222222222222,
              "x": 2.0,
              "y": 0.0,
              "theta": 0.0,
              "action": null
            },
            {
              "t": 24.31236111111111,
              "x": 2.1206125,
              "y": 0.0,
              "theta": 0.0,
              "action": {
                "movement": "m",
                "index": 2,
                "text": "move 1 meters until { front } detect"
              }
            },
            {
              "t": 25.7425,
              "x": 2.249325,
              "y": 0.0,
              "theta": 0.0,
              "action": {
                "movement": "m",
                "index": 2,
                "text": "move 1 meters until { front } detect"
              }
            },
            {
              "t": 27.172638888888887,
              "x": 2.3780375,
              "y": 0.0,
              "theta": 0.0,
              "action": {
                "movement": "m",
                "index": 2,
                "text": "move 1 meters until { front } detect"
              }
            },
            {
              "t": 28.602777777777778,
              "x": 2.5067500000000003,
              "y": 0.0,
              "theta": 0.0,
              "action": {
                "movement": "m",
                "index": 2,
                "text": "move 1 meters until { front } detect"
              }
            },
            {
              "t": 30.032916666666665,
              "x": 2.6354625,
              "y": 0.0,
              "theta": 0.0,
              "action": {
                "movement": "m",
                "index": 2,
                "text": "move 1 meters until { front } detect"
              }
            },
            {
              "t": 31.463055555555556,
              "x": 2.764175,
              "y": 0.0,
              "theta": 0.0,
              "action": {
                "movement": "m",
                "index": 2,
                "text": "move 1 meters until { front } detect"
              }
            },
            {
              "t": 32.89319444444445,
              "x": 2.8928875,
              "y": 0.0,
              "theta": 0.0,
              "action": {
                "movement": "m",
                "index": 2,
                "text": "move 1 meters until { front } detect"
              }
            },
            {
              "t": 34.32333333333333,
              "x": 3.0,
              "y": 0.0,
              "theta": 0.0,
              "action": {
                "movement": "m",
                "index": 2,
                "text": "move 1 meters until { front } detect"
              }
            }
          ],
          "legs": [
            {
              "action": {
                "movement": "m",
                "index": 2,
                "text": "move 1 meters until { front } detect"
              },
              "start": 22.88222222222222,
              "duration": 11.44111111111111,
              "last": 8
            }
          ]
        }
      ]
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
      ],
      "path": {
        "points": [
          [
            0.0,
            3.0,
            3.0
          ],
          [
            5.0,
            4.0,
            3.0
          ]
        ],
        "repeat": false
      }
    }
  ],
  "collisions": [
    {
      "robot": "rover",
      "action": {
        "movement": "m",
        "index": 0,
        "text": "move 1 meters",
        "rounds": [
          1
        ],
        "counts": [
          2
        ],
        "calls": [
          {
            "movement": "m",
            "index": 1
          }
        ],
        "done": "side"
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
