//! Movements after an edit.

use pydslrep_syntax::ast::{Action, ActionKind, Block, Do, Entity, nested};
use pydslrep_syntax::{Earlier, Parse, Span, TokenKind, lex, parse, parse_again};

const PROGRAM: &str = "movement m of rover {\n  move 3.2 meters at 18.7\n  turn left until { front, back }\n  \
    repeat 5 times {\n    turn right 45.0 // a comment\n    if { front } detect within 1.0 meters {\n      \
    move 1.2 meters\n      wait 2 seconds\n    } else if { back } clear {\n      do side\n    } else {\n      \
    repeat until { front } detect {\n        turn left with radius 2 meters in reverse\n        \
    move at 3.4 until { back } clear\n      }\n    }\n    wait until { front, back } clear\n  }\n  \
    move 143.3 centimeters at 2.4\n  turn left 22.5\n  do other\n  slam\n  move 1 meters\n  turn left\n}\n";

/// Words that mean much where they do not belong.
const TYPED: [&str; 25] = [
    " ",
    "{",
    "}",
    "move ",
    "m",
    "wait ",
    "else ",
    "until ",
    "3.5 ",
    "front ",
    "/*",
    "*/",
    "// x\n",
    "at ",
    "\"",
    "repeat 2 times { slam } ",
    "sensor s ",
    "-1",
    ".",
    "’s",
    "-",
    "ä",
    "\n",
    "/",
    "# ",
];

fn again(before: &(Span, Parse), edited: Span, typed: &str, text: &str) -> Vec<(Span, Parse)> {
    let growth = i64::try_from(typed.len()).unwrap() - i64::from(edited.len());
    let end = u32::try_from(i64::from(before.0.end) + growth).unwrap();
    let now = Span::new(before.0.start, end);
    parse_again(text, Some(Earlier { parse: &before.1, now, edited, growth }))
}

/// Every place, every word: with what each edit leaves behind, as it is typed on.
#[test]
fn what_is_read_again_is_what_is_read_anew() {
    let places: Vec<u32> =
        lex(PROGRAM).iter().flat_map(|(_, span)| [span.start, span.start + 1, span.end]).collect();
    for (number, place) in places.iter().flat_map(|place| [place; 4]).enumerate() {
        let place = *place;
        let mut text = PROGRAM.to_owned();
        let mut before = parse(&text);
        let steps = (0..4).map(|step| (TYPED[(number + step * 7) % TYPED.len()], step % 2 == 0));
        for (typed, replaces) in steps {
            let [only] = &before[..] else { break };
            let end = (place + 5 * u32::from(replaces)).min(only.0.end);
            let edited = Span::new(place.min(end), end);
            text.replace_range(std::ops::Range::from(edited), typed);
            let now = again(only, edited, typed, &text);
            assert_eq!(now, parse(&text), "{text}");
            before = now;
        }
    }
}

/// Makes the actions of a tree say what the text does not: what is taken from the tree can be told from what is read.
fn mark(actions: &mut [Action]) {
    for action in actions {
        let blocks: Vec<&mut Block> = match &mut action.kind {
            ActionKind::Repeat(repeat) => {
                repeat.rounds = None;
                repeat.block.iter_mut().collect()
            }
            ActionKind::If(choice) => {
                choice.branches.iter_mut().for_each(|branch| branch.condition = None);
                let blocks = choice.branches.iter_mut().filter_map(|branch| branch.block.as_mut());
                blocks.chain(&mut choice.otherwise).collect()
            }
            kind => {
                *kind = ActionKind::Do(Do { movement: None });
                Vec::new()
            }
        };
        for block in blocks {
            mark(&mut block.actions);
        }
    }
}

fn is_marked(action: &Action) -> bool {
    match &action.kind {
        ActionKind::Repeat(repeat) => repeat.rounds.is_none(),
        ActionKind::If(choice) => choice.branches.iter().all(|branch| branch.condition.is_none()),
        ActionKind::Do(call) => call.movement.is_none(),
        _ => false,
    }
}

fn actions(parse: &mut Parse) -> &mut Vec<Action> {
    let Some(Entity::Movement(movement)) = &mut parse.entity else { panic!("no movement") };
    &mut movement.actions
}

#[test]
fn an_edit_in_the_middle_leaves_most_actions_as_they_are() {
    let mut before = parse(PROGRAM).remove(0);
    mark(actions(&mut before.1));
    let place = u32::try_from(PROGRAM.find("side").unwrap()).unwrap();
    let text = PROGRAM.replace("side", "outside");
    let mut now = again(&before, Span::at(place), "out", &text).remove(0).1;
    let now: Vec<&Action> = nested(actions(&mut now)).collect();
    let read: Vec<TokenKind> =
        now.iter().filter(|action| !is_marked(action)).map(|action| action.keyword()).collect();
    assert_eq!(read, [TokenKind::Repeat, TokenKind::If, TokenKind::Do], "two that are open and one");
    let places: Vec<Span> = now.iter().map(|action| action.span).collect();
    let mut anew = parse(&text).remove(0).1;
    assert_eq!(places, nested(actions(&mut anew)).map(|action| action.span).collect::<Vec<_>>());
}
