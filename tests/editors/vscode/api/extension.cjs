// An extension that does nothing: the editor runs the tests beside it.
exports.activate = () => undefined;
