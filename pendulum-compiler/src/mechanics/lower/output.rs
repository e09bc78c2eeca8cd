//! Lowering of outputs to scalars.

use super::context::Lower;
use super::value::Value;
use crate::algebra::expr::Id;
use crate::messages::message;
use crate::model::{self, Element, Quantity};
use crate::syntax::ast::{Expr, Kind};
use crate::syntax::text::text;

/// The scalars of an output.
#[derive(Debug, Default)]
pub(crate) struct Output {
    /// The length of a family.
    pub(crate) members: Option<usize>,
    /// The length of a vector or of a quaternion, or of each member of a family of them.
    pub(crate) components: Option<usize>,
    /// `true` if it is a rotation, or a family of rotations.
    pub(crate) rotation: bool,
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
        let (mut scalars, mut rotation) = (Vec::new(), false);
        let shape = self.members(&mut scalars, name, index, |lower, scalars, _| {
            let own = lower.output_member(output).unwrap_or_default();
            rotation = own.rotation;
            scalars.extend(own.scalars);
            own.components.unwrap_or(0)
        });
        let components = (0 < shape.components).then_some(shape.components);
        Output { members: shape.members, components, rotation, scalars, open: Vec::new() }
    }

    /// Returns one member of a family, or an output that is none.
    fn output_member(&mut self, output: &model::Output) -> Option<Output> {
        let expr = &output.statement.expr;
        let value = self.expr(expr);
        let value = self.components(value);
        let declared = output.declared.length();
        let rotation = output.declared.element == Element::Rotation;
        // An output without a unit has the shape of its value.
        let open = matches!(output.statement.kind, Kind::Scalar(None));
        let own = match &value {
            Value::Bad => return None,
            Value::Matrix(_) => {
                self.unfit(expr, &value, ", and an output is a vector; write `J*u`");
                return None;
            }
            Value::Rotation(value) if rotation || open => {
                let scalars = value.quaternion(self.graph).to_vec();
                let components = Some(scalars.len());
                return Some(Output { components, rotation: true, scalars, ..Output::default() });
            }
            Value::Rotation(_) => {
                let name = output.declared.name;
                let instead = format!(", and `{name}` is none; write `output {name}: rotation`");
                self.unfit(expr, &value, &instead);
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
        if (own != declared || rotation) && !open {
            self.shape(output, &value, own, expr);
            return None;
        }
        let scalars = value.scalars();
        let checked = scalars.iter().all(|&scalar| self.within_bounds(expr, scalar));
        checked.then(|| Output { components: own, scalars, ..Output::default() })
    }

    /// Reports an output whose declared shape differs from that of its value.
    fn shape(&mut self, output: &model::Output, value: &Value, own: Option<usize>, expr: &Expr) {
        let Quantity { name, unit, .. } = &output.declared;
        let declared = match output.declared.length() {
            _ if output.declared.element == Element::Rotation => "as a rotation".to_owned(),
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
