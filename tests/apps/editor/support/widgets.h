/// What a user does to widgets, and how a test finds them.
#pragma once

#include <gtest/gtest.h>

#include <QAbstractItemView>
#include <QAction>
#include <QLineEdit>
#include <QMainWindow>
#include <QStyleOptionViewItem>
#include <QTest>

namespace parian::editor {

/// Writes over what is in the field, and presses Return.
inline void type(QLineEdit* field, const QString& text) {
  ASSERT_NE(field, nullptr);
  field->setFocus();
  field->selectAll();
  QTest::keyClick(field, Qt::Key_Delete);
  QTest::keyClicks(field, text);
  QTest::keyClick(field, Qt::Key_Return);
}

/// The action of a menu or tool bar of that text; null where there is none.
inline QAction* find_action(QWidget& window, const QString& text) {
  for (QAction* action : window.findChildren<QAction*>())
    if (action->text().remove('&') == text) return action;
  return nullptr;
}

inline void trigger(QWidget& window, const QString& text) {
  QAction* action = find_action(window, text);
  ASSERT_NE(action, nullptr) << text.toStdString();
  EXPECT_TRUE(action->isEnabled()) << text.toStdString();
  action->trigger();
}

/// The row of that text, wherever in the tree it is.
inline QModelIndex find_row(const QAbstractItemModel& model, const QString& text) {
  return model.match(model.index(0, 0), Qt::DisplayRole, text, 1, Qt::MatchExactly | Qt::MatchRecursive)
      .value(0);
}

inline void click(QAbstractItemView& view, const QModelIndex& index, Qt::KeyboardModifiers keys = {}) {
  ASSERT_TRUE(index.isValid());
  view.scrollTo(index);
  QTest::mouseClick(view.viewport(), Qt::LeftButton, keys, view.visualRect(index).center());
}

/// Into the box of an item that can be checked.
inline void click_box(QAbstractItemView& view, const QModelIndex& index) {
  ASSERT_TRUE(index.isValid());
  view.scrollTo(index);
  QStyleOptionViewItem option;
  option.rect = view.visualRect(index);
  option.features = QStyleOptionViewItem::HasCheckIndicator;
  option.widget = &view;
  const QRect box = view.style()->subElementRect(QStyle::SE_ItemViewItemCheckIndicator, &option, &view);
  QTest::mouseClick(view.viewport(), Qt::LeftButton, {}, box.center());
}

}  // namespace parian::editor
