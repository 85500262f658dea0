//! `invalid-ip`: an octet that does not fit into a byte.

use pydslrep_syntax::ast::Entity;

use super::Rule;
use super::context::{Context, Problem};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "invalid-ip",
    severity: Severity::Error,
    summary: "the numbers of an address lie between 0 and 255",
    tag: None,
    seeks_names: false,
    check,
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Ip(ip)) = context.tree else { return };
    let Some((address, span)) = &ip.address else { return };
    if let Some(octet) = address.split('.').find(|octet| octet.parse::<u8>().is_err()) {
        problems.push(
            RULE.problem(*span, format!("`{octet}` in this address is above 255"))
                .help("an address is four numbers from 0 to 255, such as `127.0.0.1`"),
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
              help: an address is four numbers from 0 to 255, such as `127.0.0.1`
        "#]],
        );
        check_clean("ip a 255.0.10.007");
    }
}
