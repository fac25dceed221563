//! The task that makes scenes and builds their trees.

use std::collections::VecDeque;
use std::sync::Arc;

use fbvh::Options;
use metaball::{BoxError, Method, Model, Overrides};

use crate::crew::Crew;
use crate::events::Post;
use crate::mailbox::Mailbox;
use crate::subject::{Subject, told};

/// Models that are kept: that of a frame, of the one before and of the one after.
const KEPT: usize = 3;

/// What is to be built.
#[derive(Debug, Clone)]
pub(crate) struct Order {
    /// Later orders have higher numbers.
    pub(crate) number: u64,
    pub(crate) subject: Arc<Subject>,
    pub(crate) frame: u32,
    pub(crate) field: Overrides,
    pub(crate) tree: Options,
    /// The frame that will most likely be next.
    pub(crate) next: Option<u32>,
}

/// What came of an order.
#[derive(Debug)]
pub(crate) struct Built {
    pub(crate) order: Order,
    /// The model, or why there is none.
    pub(crate) model: Result<Arc<Model>, String>,
}

/// Builds beside all else, until it is dropped.
#[derive(Debug)]
pub(crate) struct Builder {
    orders: Arc<Mailbox<Order>>,
}

impl Builder {
    /// What comes of orders goes to `post`.
    pub(crate) fn new(crew: &dyn Crew, post: Post<Built>) -> Self {
        let orders = Arc::new(Mailbox::new());
        let taken = orders.clone();
        crew.begin(Box::new(move || Box::pin(work(taken, post))));
        Self { orders }
    }

    /// Builds this next, when what is being built is ready.
    pub(crate) fn order(&self, order: Order) {
        self.orders.put(order);
    }
}

impl Drop for Builder {
    fn drop(&mut self) {
        self.orders.close();
    }
}

async fn work(orders: Arc<Mailbox<Order>>, post: Post<Built>) {
    let mut kept = Kept::default();
    while let Some(order) = orders.take().await {
        let model = kept.model(&order, order.frame).map_err(|error| told(&*error));
        post.send(Built { order: order.clone(), model });
        if let (Some(next), false) = (order.next, orders.calls()) {
            // What is wrong with it is said when it is asked for.
            let _ = kept.model(&order, next);
        }
    }
}

/// The latest models.
#[derive(Default)]
struct Kept(VecDeque<Entry>);

struct Entry {
    subject: Arc<Subject>,
    frame: u32,
    field: Overrides,
    tree: Options,
    model: Arc<Model>,
}

impl Kept {
    /// The model of a frame, which may be there already.
    fn model(&mut self, order: &Order, frame: u32) -> Result<Arc<Model>, BoxError> {
        let Order { subject, field, tree, .. } = order;
        let is_like = |entry: &Entry| {
            Arc::ptr_eq(&entry.subject, subject) && entry.field == *field && entry.tree == *tree
        };
        let is_it = |entry: &&Entry| is_like(entry) && entry.frame == frame;
        if let Some(entry) = self.0.iter().find(is_it) {
            return Ok(entry.model.clone());
        }
        let scene = field.apply(subject.frame(frame)?)?;
        let model = Arc::new(Model::new(scene, &Method::Tree(*tree))?);
        self.0.retain(is_like);
        self.0.truncate(KEPT - 1);
        let (subject, field, tree) = (subject.clone(), *field, *tree);
        let entry = Entry { subject, frame, field, tree, model: model.clone() };
        self.0.push_front(entry);
        Ok(model)
    }
}
