// The compiler itself: a macro cannot be called by a program. Its modules name each other from the root of the crate, so that this list is
// included there.

#[path = "../../pendulum-compiler/src/articulated/mod.rs"]
mod articulated;
#[path = "../../pendulum-compiler/src/ast.rs"]
mod ast;
#[path = "../../pendulum-compiler/src/cancel.rs"]
mod cancel;
#[path = "../../pendulum-compiler/src/check/mod.rs"]
mod check;
#[path = "../../pendulum-compiler/src/clock.rs"]
mod clock;
#[path = "../../pendulum-compiler/src/collect.rs"]
mod collect;
#[path = "../../pendulum-compiler/src/derive.rs"]
mod derive;
#[path = "../../pendulum-compiler/src/diff.rs"]
mod diff;
#[path = "../../pendulum-compiler/src/emit/mod.rs"]
mod emit;
#[path = "../../pendulum-compiler/src/error.rs"]
mod error;
#[path = "../../pendulum-compiler/src/expand.rs"]
mod expand;
#[path = "../../pendulum-compiler/src/expr/mod.rs"]
mod expr;
#[path = "../../pendulum-compiler/src/jacobian.rs"]
mod jacobian;
#[path = "../../pendulum-compiler/src/jet/mod.rs"]
mod jet;
#[path = "../../pendulum-compiler/src/latex.rs"]
mod latex;
#[path = "../../pendulum-compiler/src/lower/mod.rs"]
mod lower;
#[path = "../../pendulum-compiler/src/mirror.rs"]
mod mirror;
#[path = "../../pendulum-compiler/src/modular.rs"]
mod modular;
#[path = "../../pendulum-compiler/src/motion.rs"]
mod motion;
#[path = "../../pendulum-compiler/src/name.rs"]
mod name;
#[path = "../../pendulum-compiler/src/number.rs"]
mod number;
#[path = "../../pendulum-compiler/src/order.rs"]
mod order;
#[path = "../../pendulum-compiler/src/parse/mod.rs"]
mod parse;
#[path = "../../pendulum-compiler/src/print.rs"]
mod print;
#[path = "../../pendulum-compiler/src/rule.rs"]
mod rule;
#[path = "../../pendulum-compiler/src/schedule/mod.rs"]
mod schedule;
#[path = "../../pendulum-compiler/src/sign.rs"]
mod sign;
#[path = "../../pendulum-compiler/src/solve.rs"]
mod solve;
#[path = "../../pendulum-compiler/src/symmetry.rs"]
mod symmetry;
#[path = "../../pendulum-compiler/src/unit/mod.rs"]
mod unit;
#[path = "../../pendulum-compiler/src/value.rs"]
mod value;
