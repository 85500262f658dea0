//! Hints in blocks.

use expect_test::expect;

use super::*;

/// The tooltips of a movement, one a line.
fn tooltips(movement: &str) -> String {
    let text = format!("{PARTS}{movement}");
    let found = hints(&text, Span::of(&text), InlayHintOptions { defaults: false, ..Default::default() });
    found.iter().map(|hint| hint.tooltip.lines().next().unwrap_or_default().to_owned() + "\n").collect()
}

#[test]
fn rounds_have_the_poses_of_the_first_and_after_all() {
    let movement = "movement m of rover {
  move 1 meters
  repeat 3 times {
    move 2 meters
    repeat 2 times {
      turn left 30
    }
  }
  wait 1 seconds
}
";
    check(
        movement,
        &expect![[r#"
        movement m of rover {
          move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
          repeat 3 times {
            move 2 meters«at 9.0»«· 22.6 s → 3.00, 0.00, 0°»
            repeat 2 times {
              turn left 30«· 1.2 s → 3.00, 0.00, 30°»
            }«· 2.4 s → 3.00, 0.00, 60°»
          }«· 1 min 14.9 s → 3.00, 3.46, 180°»
          wait 1 seconds«· 1.0 s → 3.00, 3.46, 180°»
        }
    "#]],
    );
    expect![[r#"
        Takes 11.4 s. From (0 m, 0 m, 0°) to (1 m, 0 m, 0°), relative to the start of the movement.
        Takes 22.6 s. In the first round from (1 m, 0 m, 0°) to (3 m, 0 m, 0°), relative to the start of the movement.
        Takes 1.2 s. In the first round from (3 m, 0 m, 0°) to (3 m, 0 m, 30°), relative to the start of the movement.
        Takes 2.4 s. In the first round from (3 m, 0 m, 0°) to (3 m, 0 m, 60°), relative to the start of the movement.
        Takes 1 min 14.9 s. From (1 m, 0 m, 0°) to (3 m, 3.464 m, 180°), relative to the start of the movement.
        Takes 1.0 s. From (3 m, 3.464 m, 180°) to (3 m, 3.464 m, 180°), relative to the start of the movement.
    "#]].assert_eq(&tooltips(movement));
}

#[test]
fn in_a_branch_is_where_the_robot_is_if_it_is_done() {
    let movement = "movement m of rover {
  move 1 meters
  if { front } detect {
    turn left
  } else if { front } clear within 1 meters {
    move 2 meters
  } else {
    wait 1 seconds
  }
  move 1 meters
}
";
    check(
        movement,
        &expect![[r#"
        movement m of rover {
          move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
          if { front } detect {
            turn left«90»«· 2.9 s → 1.00, 0.00, 90°»
          } else if { front } clear within 1 meters {
            move 2 meters«at 9.0»«· 22.6 s → 3.00, 0.00, 0°»
          } else {
            wait 1 seconds«· 1.0 s → 1.00, 0.00, 0°»
          }«· pose unknown»
          move 1 meters«at 9.0»«· 11.4 s»
        }
    "#]],
    );
    expect![[r#"
        Takes 11.4 s. From (0 m, 0 m, 0°) to (1 m, 0 m, 0°), relative to the start of the movement.
        Takes 2.9 s. If it is done, from (1 m, 0 m, 0°) to (1 m, 0 m, 90°), relative to the start of the movement.
        Takes 22.6 s. If it is done, from (1 m, 0 m, 0°) to (3 m, 0 m, 0°), relative to the start of the movement.
        Takes 1.0 s. If it is done, from (1 m, 0 m, 0°) to (1 m, 0 m, 0°), relative to the start of the movement.
        Poses from here on cannot be planned: what `if { front } detect` does depends on its sensors.
        Takes 11.4 s. The start pose cannot be planned: what `if { front } detect` does depends on its sensors.
    "#]].assert_eq(&tooltips(movement));
    // Both branches lead to the same pose in the same time.
    check(
        "movement m of rover {
  if { front } detect {
    turn left
    turn right
  } else {
    turn right
    turn left
  }
  move 1 meters
}
",
        &expect![[r#"
            movement m of rover {
              if { front } detect {
                turn left«90»«· 2.9 s → 0.00, 0.00, 90°»
                turn right«90»«· 2.9 s → 0.00, 0.00, 0°»
              } else {
                turn right«90»«· 2.9 s → 0.00, 0.00, -90°»
                turn left«90»«· 2.9 s → 0.00, 0.00, 0°»
              }«· 5.9 s → 0.00, 0.00, 0°»
              move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
            }
        "#]],
    );
}

#[test]
fn after_a_condition_nothing_is_concluded() {
    let movement = "movement m of rover {
  repeat until { front } detect {
    move 1 meters
    turn left
  }
  turn left
}
";
    check(
        movement,
        &expect![[r#"
        movement m of rover {
          repeat until { front } detect {
            move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
            turn left«90»«· 2.9 s → 1.00, 0.00, 90°»
          }«· pose unknown»
          turn left«90»«· 2.9 s»
        }
    "#]],
    );
    expect![[r#"
        Takes 11.4 s. If it is done in the first round, from (0 m, 0 m, 0°) to (1 m, 0 m, 0°), relative to the start of the movement.
        Takes 2.9 s. If it is done in the first round, from (1 m, 0 m, 0°) to (1 m, 0 m, 90°), relative to the start of the movement.
        Poses from here on cannot be planned: `repeat until { front } detect` ends when its condition holds.
        Takes 2.9 s. The start pose cannot be planned: `repeat until { front } detect` ends when its condition holds.
    "#]].assert_eq(&tooltips(movement));
    let movement = "movement m of rover {
  repeat 4 times {
    move 1 meters
    move 3 meters until { front } detect
    turn left
    repeat 2 times {
      move 1 meters
    }
  }
  turn left
}
";
    check(
        movement,
        &expect![[r#"
        movement m of rover {
          repeat 4 times {
            move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
            move 3 meters until { front } detect«· pose unknown»
            turn left«90»«· 2.9 s»
            repeat 2 times {
              move 1 meters«at 9.0»«· 11.4 s»
            }«· 22.9 s»
          }
          turn left«90»«· 2.9 s»
        }
    "#]],
    );
    expect![[r#"
        Takes 11.4 s. In the first round from (0 m, 0 m, 0°) to (1 m, 0 m, 0°), relative to the start of the movement.
        Poses from here on cannot be planned: `move 3 meters until { front } detect` ends when its condition holds.
        Takes 2.9 s. The start pose cannot be planned: `move 3 meters until { front } detect` ends when its condition holds.
        Takes 11.4 s. The start pose cannot be planned: `move 3 meters until { front } detect` ends when its condition holds.
        Takes 22.9 s. The start pose cannot be planned: `move 3 meters until { front } detect` ends when its condition holds.
        Takes 2.9 s. The start pose cannot be planned: `move 3 meters until { front } detect` ends when its condition holds.
    "#]].assert_eq(&tooltips(movement));
}

#[test]
fn a_done_movement_that_is_open_is_said_once() {
    check(
        "movement find of rover { slam }
movement m of rover {
  repeat 2 times {
    turn left
    do find
    turn left
  }
  turn left
}
",
        &expect![[r#"
            movement find of rover { slam }
            movement m of rover {
              repeat 2 times {
                turn left«90»«· 2.9 s → 0.00, 0.00, 90°»
                do find«· pose unknown»
                turn left«90»«· 2.9 s»
              }
              turn left«90»«· 2.9 s»
            }
        "#]],
    );
}

const NESTED: &str = "movement m of rover {
  move 1 meters
  repeat 2 times {
    move 2 meters
    if { front } clear {
      turn left
      turn right
    } else {
      turn right
      turn left
    }
    move 1 meters
  }
  turn left
}
";

#[test]
fn what_is_typed_in_a_block_removes_no_hints_around_it() {
    let mut editor = Editor::new(NESTED);
    expect![[r#"
        movement m of rover {
          move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
          repeat 2 times {
            move 2 meters«at 9.0»«· 22.6 s → 3.00, 0.00, 0°»
            if { front } clear {
              turn left«90»«· 2.9 s → 3.00, 0.00, 90°»
              turn right«90»«· 2.9 s → 3.00, 0.00, 0°»
            } else {
              turn right«90»«· 2.9 s → 3.00, 0.00, -90°»
              turn left«90»«· 2.9 s → 3.00, 0.00, 0°»
            }«· 5.9 s → 3.00, 0.00, 0°»
            move 1 meters«at 9.0»«· 11.4 s → 4.00, 0.00, 0°»
          }«· 1 min 19.8 s → 7.00, 0.00, 0°»
          turn left«90»«· 2.9 s → 7.00, 0.00, 90°»
        }
    "#]]
    .assert_eq(&editor.shown());
    expect![[r#"
        move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
        move 2 meters«at 9.0»«· 22.6 s → 3.00, 0.00, 0°»
        turn left«90»«· 2.9 s → 3.00, 0.00, 90°»
        turn right«90»«· 2.9 s → 3.00, 0.00, 0°»
        turn right«90»«· 2.9 s → 3.00, 0.00, -90°»
        turn left«90»«· 2.9 s → 3.00, 0.00, 0°»
        }«· 5.9 s → 3.00, 0.00, 0°»
        move 1 meters«at 9.0»«· 11.4 s → 4.00, 0.00, 0°»
        }«· 1 min 19.8 s → 7.00, 0.00, 0°»
        turn left«90»«· 2.9 s → 7.00, 0.00, 90°»
        ---
        move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
        move 2 meters«at 9.0»«· 22.6 s → 3.00, 0.00, 0°»
        turn left«90»«· 2.9 s → 3.00, 0.00, 90°»
        turn right«90»«· 2.9 s → 3.00, 0.00, 0°»
        turn right«90»«· 2.9 s → 3.00, 0.00, -90°»
        turn left«90»«· 2.9 s → 3.00, 0.00, 0°»
        }«· pose unknown»
        move 1 meters«at 9.0»«· 11.4 s»
        turn left«90»«· 2.9 s»
        ---
        move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
        move 2 meters«at 9.0»«· 22.6 s → 3.00, 0.00, 0°»
        turn left«90»«· 2.9 s → 3.00, 0.00, 90°»
        turn right«90»«· 2.9 s → 3.00, 0.00, 0°»
        move 1 meters«at 9.0»«· 11.4 s → 4.00, 0.00, 0°»
        turn right«90»«· 2.9 s → 3.00, 0.00, -90°»
        turn left«90»«· 2.9 s → 3.00, 0.00, 0°»
        }«· pose unknown»
        move 1 meters«at 9.0»«· 11.4 s»
        turn left«90»«· 2.9 s»
    "#]]
    .assert_eq(&editor.types("turn left\n      turn right", "\n      move 1 meters\n"));
    expect![[r#"
        movement m of rover {
          move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
          repeat 2 times {
            move 2 meters«at 9.0»«· 22.6 s → 3.00, 0.00, 0°»
            if { front } clear {
              turn left«90»«· 2.9 s → 3.00, 0.00, 90°»
              turn right«90»«· 2.9 s → 3.00, 0.00, 0°»
              move 1 meters«at 9.0»«· 11.4 s → 4.00, 0.00, 0°»

            } else {
              turn right«90»«· 2.9 s → 3.00, 0.00, -90°»
              turn left«90»«· 2.9 s → 3.00, 0.00, 0°»
            }«· pose unknown»
            move 1 meters«at 9.0»«· 11.4 s»
          }
          turn left«90»«· 2.9 s»
        }
    "#]]
    .assert_eq(&editor.shown());
}

#[test]
fn other_lines_stay_while_one_in_a_block_has_an_error() {
    let mut editor = Editor::new(NESTED);
    editor.replace("move 2 meters", "mov 2 meters");
    editor.typed.clear();
    let broken = editor.shown();
    expect![[r#"
        movement m of rover {
          move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
          repeat 2 times {
            mov 2 meters
            if { front } clear {
              turn left«90»«· 2.9 s → 3.00, 0.00, 90°»
              turn right«90»«· 2.9 s → 3.00, 0.00, 0°»
            } else {
              turn right«90»«· 2.9 s → 3.00, 0.00, -90°»
              turn left«90»«· 2.9 s → 3.00, 0.00, 0°»
            }«· 5.9 s → 3.00, 0.00, 0°»
            move 1 meters«at 9.0»«· 11.4 s → 4.00, 0.00, 0°»
          }«· 1 min 19.8 s → 7.00, 0.00, 0°»
          turn left«90»«· 2.9 s → 7.00, 0.00, 90°»
        }
    "#]]
    .assert_eq(&broken);
    // Another line is edited.
    expect![[r#"
        move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
        turn left«90»«· 2.9 s → 3.00, 0.00, 90°»
        turn right«90»«· 2.9 s → 3.00, 0.00, 0°»
        turn right«90»«· 2.9 s → 3.00, 0.00, -90°»
        turn left«90»«· 2.9 s → 3.00, 0.00, 0°»
        }«· 5.9 s → 3.00, 0.00, 0°»
        move 1 meters«at 9.0»«· 11.4 s → 4.00, 0.00, 0°»
        }«· 1 min 19.8 s → 7.00, 0.00, 0°»
        turn left«90»«· 2.9 s → 7.00, 0.00, 90°»
    "#]]
    .assert_eq(&editor.types("turn left\n}", "\n"));
}

#[test]
fn only_what_is_in_sight_of_a_block_is_planned() {
    let text = format!("{PARTS}{NESTED}{}", NESTED.replace("movement m", "movement n"));
    let line = text.find("      turn right\n    }").unwrap();
    let range = Span::new(u32::try_from(line).unwrap(), u32::try_from(line + 16).unwrap());
    let labels: Vec<String> =
        hints(&text, range, InlayHintOptions::default()).into_iter().map(|hint| hint.label).collect();
    expect!["90 · 2.9 s → 3.00, 0.00, 0°"].assert_eq(&labels.join(" "));
}

#[test]
fn the_first_example_has_them() {
    let text = include_str!("../../../../../examples/square.pyr");
    let mut shown = text.to_owned();
    for hint in hints(text, Span::of(text), InlayHintOptions::default()).iter().rev() {
        shown.insert_str(hint.offset as usize, &format!("«{}»", hint.label));
    }
    let shown = shown.lines().map(str::trim).filter(|line| line.contains('«'));
    expect![[r#"
        move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
        turn left«90»«· 2.9 s → 1.00, 0.00, 90°»
        }«· 57.6 s → 0.00, 0.00, 0°»
        move 100 centimeters at 15«· 7.1 s → 1.00, 0.00, 0°»
        turn right 90«· 2.9 s → 1.00, 0.00, -90°»
        }«· 40.3 s → 0.00, 0.00, 0°»"#]]
    .assert_eq(&shown.collect::<Vec<_>>().join("\n"));
}
