//! Descriptions of the tokens that the parser expects.

use std::fmt;

/// The description of an expected token.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Expected(&'static str);

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}

// Signs.
pub(crate) const CLOSING_BRACKET: Expected = Expected("the closing bracket");
pub(crate) const COMMA: Expected = Expected("`,`");
pub(crate) const EQUALS: Expected = Expected("`=`");
pub(crate) const GREATER_OR_EQUAL: Expected = Expected("`>=`");
pub(crate) const SEMICOLON: Expected = Expected("`;`");

// Names.
pub(crate) const ARGUMENT: Expected = Expected("the name of an argument");
pub(crate) const BODY: Expected = Expected("the name of a body");
pub(crate) const CONSTRAINT: Expected = Expected("the name of a constraint");
pub(crate) const CONTROL_INPUT: Expected = Expected("the name of a control input");
pub(crate) const COORDINATE: Expected = Expected("the name of a coordinate");
pub(crate) const DEFINITION: Expected = Expected("the name of a definition");
pub(crate) const DRIVEN_INPUT: Expected = Expected("the name of a driven input");
pub(crate) const FORCED_COORDINATE: Expected = Expected("the coordinate on which the force acts");
pub(crate) const INDEX: Expected = Expected("the name of an index");
pub(crate) const OUTPUT: Expected = Expected("the name of an output");
pub(crate) const PARAMETER: Expected = Expected("the name of a parameter");
pub(crate) const POINT: Expected =
    Expected("the point of integration; write `integral(p in B, …)`");
pub(crate) const STRUCT: Expected = Expected("the name of the struct");

// Parts of expressions and statements.
pub(crate) const COMPONENT: Expected = Expected("a component, `x`, `y` or `z`");
pub(crate) const END_OF_RANGE: Expected = Expected("`..` and the end of the range");
pub(crate) const EXPRESSION: Expected = Expected("a number, a name, `(`, `[` or `|`");
pub(crate) const IN_BODY: Expected = Expected("`in` and the name of a body");
pub(crate) const IN_RANGE: Expected = Expected("`in` and a range such as `0..5`");
pub(crate) const REDUNDANT_CONSTRAINT: Expected =
    Expected("`constraint`, as in `redundant constraint`");
pub(crate) const STATEMENT: Expected = Expected("a statement such as `coordinate θ: rad;`");
