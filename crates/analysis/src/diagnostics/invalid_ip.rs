//! `invalid-ip`: an octet that does not fit into a byte.

use pydslrep_syntax::ast::Entity;

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "invalid-ip",
    severity: Severity::Error,
    summary: "a number in an ip address is above 255",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "One of the four numbers of an ip address is larger than 255.",
    why: "The address is that of the computer on which the simulator runs. Each of its four numbers is between 0 and \
        255, so no computer has this address. Your own computer is always `127.0.0.1`.",
    imports: &[],
    example: "ip lab 192.168.0.300",
    fixed: "ip lab 192.168.0.30",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Ip(ip)) = context.tree else { return };
    let Some((address, span)) = &ip.address else { return };
    if let Some(octet) = address.split('.').find(|octet| octet.parse::<u8>().is_err()) {
        problems.push(
            RULE.problem(*span, format!("`{octet}` in this address is above 255"))
                .help("an address has four numbers from 0 to 255; `127.0.0.1` is this computer"),
        );
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    #[test]
    fn octets_are_bytes() {
        check(
            "ip a 127.0.0.256",
            &expect![[r#"
                error[invalid-ip] 1:6 "127.0.0.256" `256` in this address is above 255
                  help: an address has four numbers from 0 to 255; `127.0.0.1` is this computer
            "#]],
        );
        check_clean("ip a 255.0.10.007");
    }
}
