// The compiler itself: a macro cannot be called by a program. Its modules name each other from the root of the crate, so that this list is
// included there.

#[path = "../../pendulum-macros/src/articulated/mod.rs"]
mod articulated;
#[path = "../../pendulum-macros/src/ast.rs"]
mod ast;
#[path = "../../pendulum-macros/src/cancel.rs"]
mod cancel;
#[path = "../../pendulum-macros/src/check/mod.rs"]
mod check;
#[path = "../../pendulum-macros/src/clock.rs"]
mod clock;
#[path = "../../pendulum-macros/src/collect.rs"]
mod collect;
#[path = "../../pendulum-macros/src/derive.rs"]
mod derive;
#[path = "../../pendulum-macros/src/diff.rs"]
mod diff;
#[path = "../../pendulum-macros/src/emit/mod.rs"]
mod emit;
#[path = "../../pendulum-macros/src/error.rs"]
mod error;
#[path = "../../pendulum-macros/src/expand.rs"]
mod expand;
#[path = "../../pendulum-macros/src/expr/mod.rs"]
mod expr;
#[path = "../../pendulum-macros/src/jacobian.rs"]
mod jacobian;
#[path = "../../pendulum-macros/src/jet/mod.rs"]
mod jet;
#[path = "../../pendulum-macros/src/latex.rs"]
mod latex;
#[path = "../../pendulum-macros/src/lower/mod.rs"]
mod lower;
#[path = "../../pendulum-macros/src/mirror.rs"]
mod mirror;
#[path = "../../pendulum-macros/src/modular.rs"]
mod modular;
#[path = "../../pendulum-macros/src/motion.rs"]
mod motion;
#[path = "../../pendulum-macros/src/name.rs"]
mod name;
#[path = "../../pendulum-macros/src/number.rs"]
mod number;
#[path = "../../pendulum-macros/src/order.rs"]
mod order;
#[path = "../../pendulum-macros/src/parse/mod.rs"]
mod parse;
#[path = "../../pendulum-macros/src/print.rs"]
mod print;
#[path = "../../pendulum-macros/src/rule.rs"]
mod rule;
#[path = "../../pendulum-macros/src/schedule/mod.rs"]
mod schedule;
#[path = "../../pendulum-macros/src/sign.rs"]
mod sign;
#[path = "../../pendulum-macros/src/solve.rs"]
mod solve;
#[path = "../../pendulum-macros/src/symmetry.rs"]
mod symmetry;
#[path = "../../pendulum-macros/src/unit/mod.rs"]
mod unit;
#[path = "../../pendulum-macros/src/value.rs"]
mod value;
