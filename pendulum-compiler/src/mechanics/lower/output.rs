//! Lowering of outputs to scalars.

use super::context::Lower;
use super::value::Value;
use crate::algebra::expr::Id;
use crate::messages::message;
use crate::model::{self, Quantity};
use crate::syntax::ast::{Expr, Kind};
use crate::syntax::text::text;

/// The scalars of an output.
#[derive(Debug, Default)]
pub(crate) struct Output {
    /// The length of a family.
    pub(crate) members: Option<usize>,
    /// The length of a vector, or of each member of a family of vectors.
    pub(crate) components: Option<usize>,
    /// The components of the first member, followed by those of the second, and so on.
    pub(crate) scalars: Vec<Id>,
    /// The scalars with accelerations and reactions as symbols, if limits in contact or frictions
    /// change their values; otherwise empty.
    pub(crate) open: Vec<Id>,
}

impl Lower<'_, '_, '_, '_> {
    /// Returns the outputs in the order of declaration. An output with a mistake has no scalars.
    pub(super) fn outputs(&mut self) -> Vec<Output> {
        self.accelerations = true;
        let outputs = self.model.outputs.iter().map(|output| self.output(output)).collect();
        self.accelerations = false;
        outputs
    }

    fn output(&mut self, output: &model::Output) -> Output {
        let (statement, name) = (output.statement, output.declared.name);
        let index = statement.index.as_ref();
        if let Some(binder) = index
            && let range = self.range(binder)
            && range.start != 0
            && !range.is_empty()
        {
            let message =
                message!("the members of `{name}` are counted from 0; begin the range there");
            self.errors.once(binder.low.source, binder.low.range, message);
        }
        let mut scalars = Vec::new();
        let shape = self.members(&mut scalars, name, index, |lower, scalars, _| {
            let (components, own) = lower.output_member(output).unwrap_or_default();
            scalars.extend(own);
            components.unwrap_or(0)
        });
        let components = (0 < shape.components).then_some(shape.components);
        Output { members: shape.members, components, scalars, open: Vec::new() }
    }

    /// Returns the length of a vector, and its scalars.
    fn output_member(&mut self, output: &model::Output) -> Option<(Option<usize>, Vec<Id>)> {
        let expr = &output.statement.expr;
        let value = self.expr(expr);
        let value = self.components(value);
        let declared = output.declared.length();
        let own = match &value {
            Value::Bad => return None,
            Value::Matrix(_) => {
                self.unfit(expr, &value, ", and an output is a vector; write `J*u`");
                return None;
            }
            Value::Rotation(_) => {
                let instead = ", and an output is made of numbers; write directions that it \
                               turns, as in `R*[1, 0, 0]`";
                self.unfit(expr, &value, instead);
                return None;
            }
            Value::Family(members) => {
                if members.iter().any(|member| !matches!(member, Value::Scalar(_))) {
                    let (name, count) = (output.declared.name, members.len());
                    let (found, unit) = (text(expr), between_brackets(&output.declared.unit));
                    let message = message!(
                        "`{found}` is a family of vectors; write `output {name}[k in 0..{count}]: \
                         [{unit}; 2] = {found}[k];`"
                    );
                    self.wrong(expr, message);
                    return None;
                }
                Some(members.len())
            }
            value => value.parts().map(<[Id]>::len),
        };
        // An output without a unit has the shape of its value.
        let open = matches!(output.statement.kind, Kind::Scalar(None));
        if own != declared && !open {
            self.shape(output, &value, own, expr);
            return None;
        }
        let scalars = value.scalars();
        let checked = scalars.iter().all(|&scalar| self.within_bounds(expr, scalar));
        checked.then_some((own, scalars))
    }

    /// Reports an output whose declared shape differs from that of its value.
    fn shape(&mut self, output: &model::Output, value: &Value, own: Option<usize>, expr: &Expr) {
        let Quantity { name, unit, .. } = &output.declared;
        let declared = match output.declared.length() {
            None => "as a scalar".to_owned(),
            Some(length) => format!("with {length} components"),
        };
        let unit = between_brackets(unit);
        let own = match own {
            None => unit.to_owned(),
            Some(length) => format!("[{unit}; {length}]"),
        };
        let instead = format!(", but `{name}` is declared {declared}; write `{own}`");
        self.unfit(expr, value, &instead);
    }
}

/// Returns a unit in the form required inside the brackets of a vector.
fn between_brackets(unit: &str) -> &str {
    if unit.is_empty() { "_" } else { unit }
}
